// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/grain_frame.h"
#include "bpm/forces/grain_grid.h"
#include "bpm/forces/network_data.h"
#include "bpm/packing/box.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boba {

/// Two planes between grains a and b, across the line of their centres: no place of a has x . normal above `last_of_a`
/// where its frame puts it, none of b below `first_of_b`.
struct Gap {
  Vector3 normal = Vector3::Zero();
  double last_of_a = 0.0, first_of_b = 0.0;
  /// Distance that the places keep, d; what is not positive says nothing of the grains.
  double width() const { return first_of_b - last_of_a; }
};

/// The narrowest such planes. Where the centres coincide there is no line, and a gap of width 0.
Gap gap_between(const GrainGrid& a, const GrainFrame& frame_a, const GrainGrid& b, const GrainFrame& frame_b);

/// Adds the pairs (node i of `a`, node j of `b`) closer than `radius`, measured where a's nodes are sorted; `b_to_a`
/// brings b's there. Places inserted later count too, so that a pair may be added more than once. The radius must not
/// exceed the reach of the grids.
void add_pairs_between(const GrainGrid& a, const GrainGrid& b, const GrainFrame& b_to_a, double radius,
                       std::vector<kernels::NodePair>& pairs);

/// Adds the unbonded pairs i < j inside a grain that are closer than `radius`, which must not exceed the reach.
void add_pairs_inside(const GrainGrid& grid, const NetworkData& network, double radius,
                      std::vector<kernels::NodePair>& pairs);

/// Adds the nodes of a grid that are closer than `radius` to x (d), inserted places included.
void add_nodes_near(const GrainGrid& grid, const Vector3& x, double radius, std::vector<std::int32_t>& nodes);

} // namespace boba
