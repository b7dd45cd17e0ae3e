// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/long_range_order.h"

#include "bpm/measure/near_centres.h"
#include "bpm/measure/phase_sums.h"
#include "bpm/measure/reciprocal_lattice.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

namespace boba::measure {

namespace {

void check_periodic_centres(const Box& box, std::span<const Vector3> centres, const char* what) {
  if (box.periodic() != std::array{true, true, true}) {
    throw std::invalid_argument(fmt::format("{}: the box must be periodic in all three directions", what));
  }
  if (centres.empty()) {
    throw std::invalid_argument(fmt::format("{}: there are no grains", what));
  }
}

} // namespace

BraggPeak bragg_peak(const Box& box, std::span<const Vector3> centres) {
  check_periodic_centres(box, centres, "Bragg peak");
  constexpr double reach = 1.4; // of 2 pi over the spacing
  const auto n = static_cast<double>(centres.size());
  const ReciprocalLattice lattice(box, reach * 2.0 * std::numbers::pi * std::cbrt(n / box.volume()));
  BraggPeak peak;
  PhaseSums phases;
  std::vector<std::complex<double>> sums;
  const ReciprocalRow* before = nullptr;
  for (const ReciprocalRow& row : lattice.rows()) {
    if (!before || before->n1 != row.n1) {
      phases.start(box, centres, row);
    }
    before = &row;
    sums.resize(static_cast<std::size_t>(row.size()));
    phases.sum_row(row, sums);
    for (int k = 0; k < row.size(); ++k) {
      const double height = std::norm(sums[static_cast<std::size_t>(k)]) / (n * n);
      if (height > peak.height) {
        peak = {height, lattice.q(row.n1, row.n2, row.low + k)};
      }
    }
  }
  return peak;
}

std::vector<PairShell> pair_distribution(const Box& box, std::span<const Vector3> centres, double reach, double width) {
  check_periodic_centres(box, centres, "pair distribution");
  const NearCentres near(box, centres);
  const double n = static_cast<double>(centres.size()), step = width * near.spacing();
  std::vector<PairShell> shells(static_cast<std::size_t>(std::lround(reach / width)));
  std::vector<std::int64_t> directed(shells.size(), 0); // every pair from both of its ends
  for (std::size_t grain = 0; grain < centres.size(); ++grain) {
    for (const NearCentre& other : near.within(static_cast<int>(grain), step * static_cast<double>(shells.size()))) {
      ++directed[std::min(shells.size() - 1, static_cast<std::size_t>(other.distance / step))];
    }
  }
  for (std::size_t k = 0; k < shells.size(); ++k) {
    const double inner = step * static_cast<double>(k), outer = inner + step;
    const double random =
        n * (n / box.volume()) * 4.0 / 3.0 * std::numbers::pi * (std::pow(outer, 3) - std::pow(inner, 3));
    shells[k] = {0.5 * (inner + outer), directed[k] / 2, static_cast<double>(directed[k]) / random};
  }
  return shells;
}

} // namespace boba::measure
