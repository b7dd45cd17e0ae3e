// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/trajectory.h"
#include "bpm/scene/scene.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// The scene that a trajectory came from; nothing when it names none that can be read.
std::optional<Scene> scene_of_trajectory(const TrajectoryOrigin& origin, const std::filesystem::path& path);

/// Reads a scene that is to be run. One that begins with a frame of a trajectory takes over the constants of
/// [material] that the trajectory was computed with, but for those that it gives itself. What applies is narrated and
/// kept as overrides, so that scene.toml, checkpoints and the next trajectory name it. Any other scene is as
/// read_scene gives it. \throws InputError
Scene read_scene_to_run(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                        const Narrator& narrate);

} // namespace boba
