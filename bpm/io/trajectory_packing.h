// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"

#include <filesystem>

namespace boba {

/// A frame of a trajectory that Boba wrote, as a packing to start from.
///
/// Bonds and r0 are the stored ones. Frame counts from 0, or from the end when negative. Nodes rest when the trajectory
/// has no velocities. The strain is the frame's. A template's arrangement is the stored undeformed one, or that of its
/// first grain in the first frame: only r0 enters the forces. \throws
/// InputError when the file is no such trajectory or lacks the frame.
Packing read_trajectory_packing(const std::filesystem::path& file, int frame);

} // namespace boba
