// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_search.h"
#include "bpm/forces/grain_neighbours.h"
#include "bpm/forces/kernels/kernels.h"

#include <vector>

namespace boba {

/// Sums over no contacts at all; their smallest distance stays above any other.
inline constexpr double no_contact_r2 = 1e300;
inline constexpr kernels::ContactSums no_contacts = {{}, no_contact_r2, 0.0, 0};

/// Two grains that may touch, the second displaced by a lattice vector, or one grain with itself.
///
/// The candidates are all pairs of nodes that were closer than `apart` where the frames had them when they were
/// searched, sorted by i, then j: than diameter + skin, or, where there are none, than the gap between the grains.
struct ContactPair {
  int a = 0, b = 0; ///< a <= b; image > 0 when a grain meets its own image
  ImageVector image;
  std::vector<kernels::NodePair> candidates;
  std::vector<kernels::NodePair> followed; ///< those of nodes that are followed by themselves, sorted
  std::vector<kernels::NodePair> near;     ///< those that may touch in the steps to come

  bool searched = false;
  bool changed = true;         ///< since the grains last listed their nodes
  double apart = 0.0;          ///< distance that nodes which are not candidates kept at the search, d
  Gap gap;                     ///< between the grains, at the search
  GrainFrame frame_a, frame_b; ///< at the search; b's displaced by the lattice vector
  Bounds bounds_a, bounds_b;   ///< of the grains and `apart`, at the search
  Bounds zone;                 ///< where nodes of a could be near nodes of b, at the search

  std::vector<kernels::Touch> touches; ///< of the last evaluation
  kernels::ContactSums sums{};

  bool inside() const { return a == b && image == ImageVector{}; }
};

/// A pair that a grain takes part in, and whether as first (1) or second (-1).
struct ContactSide {
  int pair = 0;
  double sign = 1.0;
};

} // namespace boba
