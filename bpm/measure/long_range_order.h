// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boba::measure {

/// The highest Bragg peak of the centres.
struct BraggPeak {
  double height = 0.0;         ///< |sum_j exp(i q.r_j)|^2 / N^2, 0 to 1
  Vector3 q = Vector3::Zero(); ///< 1/d
};

/// Long-range order of the whole cell: the largest height among the wave vectors of the cell's reciprocal lattice with
/// |q| <= 1.4 * 2 pi (N / V)^(1/3), which reach just beyond the first peaks of fcc, hcp, bcc and sc.
///
/// 1 in a perfect crystal that fits the cell, fcc, hcp (its (002) peak), bcc or sc. Independent random centres have
/// about ln(6 N) / N.
/// \throws std::invalid_argument for a box that is not periodic in all directions, and without centres.
BraggPeak bragg_peak(const Box& box, std::span<const Vector3> centres);

/// One interval of distances of the pair distribution.
struct PairShell {
  double r = 0.0;           ///< its middle, d
  std::int64_t n_pairs = 0; ///< pairs, each once; with periodic copies
  double g = 0.0;           ///< pairs over those of as many independent random centres
};

/// g(r) of the centres up to `reach` spacings (V / N)^(1/3) in intervals of `width` spacings, periodic copies included
/// however small the cell is.
///
///     g = n_pairs / (N (N / V) 2/3 pi (r_2^3 - r_1^3)),  r_1, r_2 the ends of the interval
///
/// \throws std::invalid_argument for a box that is not periodic in all directions, and without centres.
std::vector<PairShell> pair_distribution(const Box& box, std::span<const Vector3> centres, double reach = 3.0,
                                         double width = 0.04);

} // namespace boba::measure
