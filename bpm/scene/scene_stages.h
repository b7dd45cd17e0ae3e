// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/scene/scene.h"
#include "bpm/scene/scene_table.h"

#include <vector>

namespace boba {

/// The stages that move nodes, in order; `insert` and `specimen` belong to the scene's start.
/// \throws InputError for what no single key can be blamed for: a stage that the cell does not allow, two pressures,
/// ...
std::vector<SceneStage> read_stages(const SceneTables& tables, const Scene& scene);

} // namespace boba
