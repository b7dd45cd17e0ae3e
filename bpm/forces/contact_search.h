// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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

/// All (other grain, image) whose bounds come within `reach` of grain g's, the grain's own images included and the grain
/// itself not. Exact for any cell, also one smaller than a grain: the integer intervals are solved for axis by axis.
/// Sorted by other.
std::vector<NeighbourGrain> neighbour_grains(int g, std::span<const Bounds> bounds, const Box& box, double reach);

/// One candidate contact: own node, other grain (index into the neighbour list; -1 is the grain itself) and its node.
struct CandidatePair {
  std::int32_t own;
  std::int32_t neighbour;
  std::int32_t node;
};

/// Adds the pairs (node of `own`, node of `other` displaced by `shift`) closer than the reach of the grids.
void add_pairs_between(const GrainGrid& own, const GrainGrid& other, const Vector3& shift, int neighbour,
                       std::vector<CandidatePair>& pairs);

/// Adds the unbonded pairs inside a grain that are closer than the reach, each from both sides.
void add_pairs_inside(const GrainGrid& own, const NetworkData& network, std::vector<CandidatePair>& pairs);

/// Adds the nodes of a grid that are closer than its reach to x (d), inserted places included.
void add_nodes_near(const GrainGrid& grid, const Vector3& x, std::vector<std::int32_t>& nodes);

} // namespace boba
