// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/elastic_constants.h"

#include <cmath>
#include <limits>

namespace boba::calibration {

namespace {

/// Frobenius norm of the fourth-rank tensor: shear components stand for 2 or 4 entries each.
double tensor_norm(const Stiffness& c) {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      sum += (i < 3 ? 1.0 : 2.0) * (j < 3 ? 1.0 : 2.0) * c(i, j) * c(i, j);
    }
  }
  return std::sqrt(sum);
}

} // namespace

ElasticConstants isotropic_part(const Stiffness& c) {
  const double iijj = c.topLeftCorner<3, 3>().sum();
  const double ijij = c.topLeftCorner<3, 3>().trace() + 2.0 * c.bottomRightCorner<3, 3>().trace();
  return {.bulk = iijj / 9.0, .shear = (ijij - iijj / 3.0) / 10.0};
}

Stiffness isotropic_stiffness(const ElasticConstants& constants) {
  Stiffness c = Stiffness::Zero();
  c.topLeftCorner<3, 3>().setConstant(constants.bulk - 2.0 / 3.0 * constants.shear);
  c.topLeftCorner<3, 3>().diagonal().array() += 2.0 * constants.shear;
  c.bottomRightCorner<3, 3>().diagonal().setConstant(constants.shear);
  return c;
}

double anisotropy(const Stiffness& c) {
  return tensor_norm(c - isotropic_stiffness(isotropic_part(c))) / tensor_norm(c);
}

double asymmetry(const Stiffness& c) {
  return tensor_norm(c - c.transpose()) / tensor_norm(c);
}

Estimate estimate(const std::vector<double>& samples) {
  const auto n = static_cast<double>(samples.size());
  Estimate result{0.0, std::numeric_limits<double>::quiet_NaN()};
  for (const double value : samples) {
    result.mean += value / n;
  }
  if (samples.size() > 1) {
    double square = 0.0;
    for (const double value : samples) {
      square += (value - result.mean) * (value - result.mean);
    }
    result.error = std::sqrt(square / (n - 1.0) / n);
  }
  return result;
}

} // namespace boba::calibration
