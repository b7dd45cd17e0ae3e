// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/packing/lane_layout.h"
#include "bpm/parallel/distribution.h"

#include <array>
#include <cstdint>
#include <vector>

namespace boba {

/// Symmetric tensor as xx yy zz xy xz yz.
using Tensor6 = std::array<double, 6>;

/// What one grain contributes to the stress: sigma = -(sum of virial + kinetic) / volume.
struct GrainSums {
  Tensor6 virial{};                               ///< sum of r_ij f_ij over bonds and half of each contact, k d^2
  Tensor6 kinetic{};                              ///< sum of m v v, k d^2
  double virial_trace = 0.0, kinetic_trace = 0.0; ///< the only members set by Virial::trace
};

/// Sums over all contacts of a packing.
struct ContactTotals {
  double largest_overlap = 0.0; ///< d; of node pairs and of nodes with walls
  double energy = 0.0;          ///< k d^2
  std::int64_t n_touching = 0;  ///< pairs
};

/// What an evaluation sums up, grain by grain: the same sums for any number of threads and ranks.
struct ForceSums {
  std::vector<GrainSums> grains;
  std::vector<kernels::ContactSums> contacts; ///< of each grain's sides

  /// Zeros for so many grains.
  void reset(int n_grains);
};

/// Gives all ranks the traces of all grains (Virial::trace), or everything of `sums.grains` (Virial::full); each rank
/// knows those of its own. Collective.
void share_grain_sums(ForceSums& sums, kernels::Virial virial, const LaneLayout& layout,
                      const Distribution& distribution);

/// The same sums with every grain's, for all ranks. Collective.
ForceSums shared_copy(const ForceSums& sums, const Distribution& distribution);

/// Totals over all grains, of a law that ends at `contact_range`, d. Collective.
ContactTotals contact_totals(const ForceSums& sums, const LaneLayout& layout, const Distribution& distribution,
                             double contact_range);

} // namespace boba
