// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/grain_frame.h"
#include "bpm/forces/grain_grid.h"
#include "bpm/forces/network_data.h"
#include "bpm/packing/box.h"

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace boba {

/// A lattice translation x + h n.
struct ImageVector {
  int a = 0, b = 0, c = 0;
  auto operator<=>(const ImageVector&) const = default;
};

/// Grain `other`, displaced by the lattice vector `image`, may touch the grain whose list this is in.
struct NeighbourGrain {
  int other = 0;
  ImageVector image;
};

/// All (other grain, image) whose bounds come within `reach` of grain g's, the grain's own images included and the
/// grain itself not. Exact for any cell, also one smaller than a grain: the integer intervals are solved for axis by
/// axis. Sorted by other.
std::vector<NeighbourGrain> neighbour_grains(int g, std::span<const Bounds> bounds, const Box& box, double reach);

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
