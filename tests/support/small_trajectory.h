// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace boba::test {

/// Three frames of three small grains of one template, with velocities, as a run writes them.
void write_small_trajectory(const std::filesystem::path& path);

/// Reads all that a trajectory holds, starts from its last frame and computes the forces there.
/// \throws InputError when it is refused; anything else is a fault.
void use_trajectory(const std::filesystem::path& path);

} // namespace boba::test
