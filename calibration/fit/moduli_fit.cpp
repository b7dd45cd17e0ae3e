// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/fit/moduli_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::calibration {

namespace {

// Of logarithms, roots and inverses of alpha + offset this left the smallest residuals (1e-4, and 1e-3 at points left
// out of the fit next to its ends); the offset lies beyond the stability limit, where K and G bend.
constexpr double offset = 1.2;
constexpr int highest_terms = 6;

double variable(double alpha) {
  return 1.0 / (alpha + offset);
}

double polynomial(const Eigen::VectorXd& coefficients, double y) {
  double value = 0.0;
  for (Eigen::Index n = coefficients.size(); n-- > 0;) {
    value = value * y + coefficients[n];
  }
  return value;
}

} // namespace

ModuliFit::ModuliFit(const std::vector<double>& alphas, const std::vector<ElasticConstants>& constants) {
  const auto [low, high] = std::minmax_element(alphas.begin(), alphas.end());
  if (alphas.size() < 3 || alphas.size() != constants.size() || *low < 0.1 - offset) {
    throw std::invalid_argument("the fit of K(alpha), G(alpha) needs at least three alphas above -1.1");
  }
  lowest_ = *low;
  highest_ = *high;
  const auto n = static_cast<Eigen::Index>(alphas.size());
  const Eigen::Index terms = std::min<Eigen::Index>(highest_terms, n - 1);
  Eigen::MatrixXd basis(n, terms);
  Eigen::VectorXd bulk(n), shear(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index t = 0; t < terms; ++t) {
      basis(i, t) = std::pow(variable(alphas[i]), static_cast<double>(t));
    }
    bulk[i] = constants[i].bulk;
    shear[i] = constants[i].shear / (alphas[i] + offset);
  }
  // Rows weighted with 1/value: the residual that counts is relative.
  const auto solve = [&](const Eigen::VectorXd& value) -> Eigen::VectorXd {
    return (value.cwiseInverse().asDiagonal() * basis).colPivHouseholderQr().solve(Eigen::VectorXd::Ones(n));
  };
  bulk_ = solve(bulk);
  shear_ = solve(shear);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ElasticConstants fitted = at(alphas[i]);
    bulk_residual_ = std::max(bulk_residual_, std::abs(fitted.bulk / constants[i].bulk - 1.0));
    shear_residual_ = std::max(shear_residual_, std::abs(fitted.shear / constants[i].shear - 1.0));
  }
}

ElasticConstants ModuliFit::at(double alpha) const {
  const double y = variable(alpha);
  return {.bulk = polynomial(bulk_, y), .shear = (alpha + offset) * polynomial(shear_, y)};
}

double ModuliFit::alpha_of_poisson(double poisson) const {
  double low = lowest_, high = highest_; // poisson falls with alpha
  const double largest = at(low).poisson(), smallest = at(high).poisson();
  if (!(poisson >= smallest && poisson <= largest)) {
    throw std::invalid_argument(
        fmt::format("poisson = {} cannot be reached: allowed are {:.4f} .. {:.4f} (alpha = {} .. {} k d)", poisson,
                    smallest, largest, highest_, lowest_));
  }
  while (high - low > 1e-12 * std::max(1.0, std::abs(high))) {
    const double middle = 0.5 * (low + high);
    (at(middle).poisson() > poisson ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

} // namespace boba::calibration
