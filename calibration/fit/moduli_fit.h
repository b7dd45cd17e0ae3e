// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/network/elastic_constants.h"

#include <vector>

namespace boba::calibration {

/// Smooth K(alpha) and G(alpha) through computed points, k = 1.
///
/// Both are polynomials in y = 1 / (alpha + 1.2) (alpha in k d): K itself, and G / (alpha + 1.2), which is bounded
/// because G grows linearly. Least squares (Eigen, QR).
class ModuliFit {
public:
  /// \throws std::invalid_argument for fewer than three points or an alpha below -1.1.
  ModuliFit(const std::vector<double>& alphas, const std::vector<ElasticConstants>& constants);

  ElasticConstants at(double alpha) const;
  double lowest_alpha() const { return lowest_; }
  double highest_alpha() const { return highest_; }
  /// Largest relative residual of K and of G at the points.
  double bulk_residual() const { return bulk_residual_; }
  double shear_residual() const { return shear_residual_; }

  /// The alpha with this Poisson ratio. \throws std::invalid_argument with the reachable interval when there is none.
  double alpha_of_poisson(double poisson) const;

private:
  Eigen::VectorXd bulk_, shear_;
  double lowest_ = 0.0, highest_ = 0.0;
  double bulk_residual_ = 0.0, shear_residual_ = 0.0;
};

} // namespace boba::calibration
