// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace boba {

/// Two nodes closer than a cut-off: position[i] - position[j] - image_shifts(period)[shift] is the short difference.
struct NearPair {
  int i = 0;
  int j = 0;
  std::int8_t shift = 13; ///< 0 .. 26, numbers the images as (sx + 1) + 3 (sy + 1) + 9 (sz + 1); 13 is none
};

/// The lattice vectors that NearPair::shift numbers, for a cuboid of the given lengths (d).
std::array<Eigen::Vector3d, 27> image_shifts(const Eigen::Vector3d& period);

/// x moved by lattice vectors into [-period/2, period/2).
Eigen::Vector3d wrapped(const Eigen::Vector3d& x, const Eigen::Vector3d& period);

/// All pairs i < j closer than `cutoff` (d), sorted by (i, j), found with a cell grid.
///
/// With `period` (a cuboid, d) nearest images count, and positions must lie in the cell [-period/2, period/2).
/// \throws std::invalid_argument when a period is shorter than twice the cut-off (a pair could then meet twice).
std::vector<NearPair> near_pairs(const std::vector<Eigen::Vector3d>& position, double cutoff,
                                 const std::optional<Eigen::Vector3d>& period);

} // namespace boba
