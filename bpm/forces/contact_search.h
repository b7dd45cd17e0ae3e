// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/network_data.h"
#include "bpm/packing/box.h"

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace boba {

/// Axis-aligned bounding box of a grain's nodes, d.
struct Bounds {
  Vector3 low = Vector3::Constant(1e300);
  Vector3 high = Vector3::Constant(-1e300);
};

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
/// Sorted by (other, image).
std::vector<NeighbourGrain> neighbour_grains(int g, std::span<const Bounds> bounds, const Box& box, double reach);

/// One candidate contact: own node, other grain (index into the neighbour list; -1 is the grain itself) and its node.
struct CandidatePair {
  std::int32_t own;
  std::int32_t neighbour;
  std::int32_t node;
};

/// Finds the pairs of one grain that are closer than a reach, through a grid of cells over the grain's own nodes.
///
/// The grid holds all own nodes: no assumption on which of them are at the surface. Of other grains only
/// the nodes inside the grain's bounds (inflated by the reach) are looked at.
class ContactSearch {
public:
  ContactSearch(std::span<const Vector3> own, const Bounds& bounds, double reach);

  /// Pairs of own nodes with nodes of another grain, which is displaced by `shift`.
  void add_neighbour(int neighbour, std::span<const Vector3> other, const Vector3& shift,
                     std::vector<CandidatePair>& pairs) const;
  /// Unbonded pairs inside the grain, each from both sides.
  void add_own(const NetworkData& network, std::vector<CandidatePair>& pairs) const;

private:
  int cell_coordinate(double x, int axis) const;
  template <class Visit> void visit_near(const Vector3& x, Visit&& visit) const;

  std::span<const Vector3> own_;
  Bounds inflated_;
  Vector3 low_;
  double reach_, inverse_cell_;
  int n_cells_[3];
  std::vector<std::int32_t> first_; ///< per cell, into sorted_
  std::vector<std::int32_t> node_;  ///< own nodes, sorted by cell
  std::vector<Vector3> sorted_;     ///< their positions
};

} // namespace boba
