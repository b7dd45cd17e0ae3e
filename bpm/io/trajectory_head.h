// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_layout.h"

namespace boba::trajectory {

/// Writes what a trajectory holds once (origin, particles, grains, bonds), and makes the datasets that grow by frames.
/// \throws std::runtime_error when the file refuses.
void write_once(const hdf5::File& file, const Topology& topology, const TrajectoryOrigin& origin,
                const TrajectoryOptions& options);

} // namespace boba::trajectory
