// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/stress.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>

namespace boba::measure {

namespace {

/// A pressure below this cannot be told from the rounding of the forces, k/d.
constexpr double least_pressure = 1e-12;

} // namespace

StressSummary summarise_stress(const Tensor6& s) {
  StressSummary summary;
  summary.pressure = -(s[0] + s[1] + s[2]) / 3.0;
  summary.mu =
      std::abs(summary.pressure) > least_pressure ? s[3] / summary.pressure : std::numeric_limits<double>::quiet_NaN();
  summary.normal_difference_1 = s[0] - s[1];
  summary.normal_difference_2 = s[1] - s[2];
  return summary;
}

Tensor6 kinetic_stress(const Box& box, std::span<const Vector3> positions, std::span<const Vector3> velocities,
                       double node_mass, const Matrix3& gradient) {
  if (positions.size() != velocities.size()) {
    throw std::invalid_argument(
        fmt::format("kinetic stress: {} positions but {} velocities", positions.size(), velocities.size()));
  }
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vector3 v = velocities[i] - gradient * (positions[i] - box.origin());
    sum += v * v.transpose();
  }
  sum *= -node_mass / box.volume();
  return {sum(0, 0), sum(1, 1), sum(2, 2), sum(0, 1), sum(0, 2), sum(1, 2)};
}

} // namespace boba::measure
