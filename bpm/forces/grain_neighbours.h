// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/bounds.h"
#include "bpm/packing/box.h"

#include <compare>
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

/// Finds the grains whose bounds come within a reach (a distance, d) of each other's, images included.
///
/// Exact for any cell, also one smaller than a grain: the integer images are solved for axis by axis. Grains stand in
/// bins of fractional coordinates, as wide as two grains and the reach, so that one is compared with those around it
/// alone; along a direction with room for fewer than three bins there is one.
class GrainNeighbours {
public:
  GrainNeighbours(std::vector<Bounds> bounds, const Box& box, double reach);

  /// All (other grain, image) within the reach of grain g, its own images included and the grain itself not. Sorted
  /// by other.
  std::vector<NeighbourGrain> of(int g) const;

private:
  Vector3 centre(int g) const { return 0.5 * (bounds_[g].low + bounds_[g].high); }
  Eigen::Vector3i bin_of(int g) const;
  std::vector<int> around(int g) const;

  std::vector<Bounds> bounds_;
  Box box_;
  double reach_;
  Eigen::Vector3i n_bins_ = Eigen::Vector3i::Ones();
  std::vector<std::vector<int>> in_bin_;
};

} // namespace boba
