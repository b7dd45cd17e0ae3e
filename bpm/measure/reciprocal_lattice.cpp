// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/reciprocal_lattice.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

namespace boba::measure {

namespace {

/// Integers n with |offset + step n| <= reach, as {low, high}; empty (low > high) for a negative reach.
std::pair<int, int> integers_within(double offset, double step, double reach) {
  // step > 0: the diagonal of 2 pi h^-T.
  return {static_cast<int>(std::ceil((-reach - offset) / step)), static_cast<int>(std::floor((reach - offset) / step))};
}

double leg(double hypotenuse, double other) {
  return std::sqrt(std::max(0.0, hypotenuse * hypotenuse - other * other));
}

} // namespace

ReciprocalLattice::ReciprocalLattice(const Box& box, double q_max) {
  if (box.periodic() != std::array{true, true, true}) {
    throw std::invalid_argument("scattering: the box must be periodic in all three directions");
  }
  if (!(q_max > 0.0) || !std::isfinite(q_max)) {
    throw std::invalid_argument(fmt::format("scattering: q_max is {} / d; it must be positive", q_max));
  }
  const double expected = box.volume() * q_max * q_max * q_max / (12.0 * std::numbers::pi * std::numbers::pi);
  if (expected > 2e9) {
    throw std::invalid_argument(
        fmt::format("scattering: q_max = {} / d means {:.3g} wave vectors in this box; lower it "
                    "so that there are fewer than 2e9",
                    q_max, expected));
  }
  b_ = 2.0 * std::numbers::pi * box.h_inverse().transpose();
  // h is upper triangular, so b is lower triangular: q_x depends on n1 alone, q_y on n1 and n2.
  const int n1_max = integers_within(0.0, b_(0, 0), q_max).second;
  for (int n1 = 0; n1 <= n1_max; ++n1) {
    const double reach_yz = leg(q_max, b_(0, 0) * n1);
    const auto [n2_low, n2_high] = integers_within(b_(1, 0) * n1, b_(1, 1), reach_yz);
    for (int n2 = n1 == 0 ? 0 : n2_low; n2 <= n2_high; ++n2) {
      const double reach_z = leg(reach_yz, b_(1, 0) * n1 + b_(1, 1) * n2);
      auto [low, high] = integers_within(b_(2, 0) * n1 + b_(2, 1) * n2, b_(2, 2), reach_z);
      if (n1 == 0 && n2 == 0) {
        low = 1;
      }
      if (low <= high) {
        rows_.push_back({n1, n2, low, high, n_vectors_});
        n_vectors_ += rows_.back().size();
      }
    }
  }
}

} // namespace boba::measure
