// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/hdf5/hdf5_file.h"
#include "bpm/packing/snapshot.h"

#include <array>
#include <cstdint>
#include <vector>

namespace boba::trajectory {

/// A bond of a stored frame may be so many times as long as at rest. A run stops at 3, but looks every 100 steps.
inline constexpr double largest_stored_stretch = 30.0;

/// Every dataset that grows by frames is there, holds numbers of its kind, and has the shape that the grains and nodes
/// give. \throws InputError.
void check_growing(const hdf5::File& file, const Topology& topology);

/// The cell of a frame, from its corner and its vectors as rows. \throws InputError unless a is along x, b in the
/// plane of x and y, and the cell can be computed with.
Box checked_box(const hdf5::File& file, std::int64_t frame, const std::vector<double>& corner,
                const std::vector<double>& edges, const std::array<bool, 3>& periodic);

/// Every value of a frame is finite and in its range: positions, velocities and centres within largest_coordinate,
/// bonds between nothing and largest_stored_stretch times their rest length, centres the means of their grains' nodes.
/// \throws InputError with the frame, what is wrong, the value and what is allowed.
void check_frame(const hdf5::File& file, std::int64_t frame, const Topology& topology, const Snapshot& snapshot);

} // namespace boba::trajectory
