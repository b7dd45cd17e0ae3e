// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/bond_order.h"

#include <array>
#include <span>
#include <vector>

namespace boba::measure {

/// Grains that hang together.
struct Cluster {
  std::vector<int> grains; ///< ascending
  /// The cluster reaches one of its own periodic copies that is displaced along this direction of the cell (a, b, c of
  /// the cell with the shortest tilts; x, y, z without tilts): it has no end there.
  std::array<bool, 3> percolates{};
  int dimension = 0; ///< of the periodic copies that hang together with it: 0 finite, 1 chain, 2 sheet, 3 all of space

  bool spans() const { return dimension > 0; }
};

/// A bond between two grains, one of them perhaps a periodic copy: vector from the first centre to the second's copy.
struct GrainBond {
  int first = 0, second = 0;
  Vector3 vector = Vector3::Zero();
};

/// Clusters of the grains that `member` names, joined by `bonds` among them; largest first, then by their first grain.
///
/// Union-find with the cell in which each grain lies relative to its cluster's root. A bond that closes a ring around
/// the cell tells the periodic copy that the cluster reaches. Source: Newman and Ziff, Phys. Rev. E 64, 016706 (2001),
/// section II D, with the winding kept as whole numbers of the cell.
/// \param centres one per grain, unwrapped or not
/// \throws std::invalid_argument for a bond that names no grain.
std::vector<Cluster> clusters(const Box& box, std::span<const Vector3> centres, const std::vector<bool>& member,
                              std::span<const GrainBond> bonds);

/// Clusters of ordered grains (`n_solid_bonds` at least `min_solid_bonds`), joined by their solid-like bonds.
std::vector<Cluster> solid_clusters(const Box& box, std::span<const Vector3> centres, const NeighbourLists& neighbours,
                                    const std::vector<BondOrder>& orders, const BondOrderOptions& options = {});

/// The most grains of any cluster that has an end in every direction; 0 without one.
int largest_finite(const std::vector<Cluster>& clusters);

} // namespace boba::measure
