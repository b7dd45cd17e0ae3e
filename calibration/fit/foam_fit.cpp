// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/fit/foam_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

namespace boba::calibration {

namespace {

/// dW/dl = sum_k 2 mu_k / (a_k l) (l^a_k - J^(-a_k b_k)).
double stress(const std::vector<FoamTerm>& terms, double stretch, double log_volume) {
  double sum = 0.0;
  for (const FoamTerm& term : terms) {
    const double b = term.poisson / (1.0 - 2.0 * term.poisson);
    sum += 2.0 * term.mu / (term.exponent * stretch) *
           (std::pow(stretch, term.exponent) - std::exp(-term.exponent * b * log_volume));
  }
  return sum;
}

/// Parameters a term: ln(mu / scale), exponent, and t with nu = -1/4 + 3/4 tanh t, so that every value is allowed.
std::vector<FoamTerm> terms_of(const Eigen::VectorXd& x, double scale) {
  std::vector<FoamTerm> terms;
  for (Eigen::Index p = 0; p + 2 < x.size(); p += 3) {
    terms.push_back({scale * std::exp(x[p]), x[p + 1], -0.25 + 0.7499 * std::tanh(x[p + 2])});
  }
  return terms;
}

struct Misfit {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const std::vector<UniaxialPoint>& points;
  double scale;
  int n_parameters;

  int inputs() const { return n_parameters; }
  int values() const { return 2 * static_cast<int>(points.size()); }
  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& residual) const {
    const std::vector<FoamTerm> terms = terms_of(x, scale);
    for (std::size_t n = 0; n < points.size(); ++n) {
      const UniaxialPoint& point = points[n];
      const auto row = static_cast<Eigen::Index>(2 * n);
      residual[row] = (foam_axial_stress(terms, point.axial_stretch, point.lateral_stretch) - point.stress) / scale;
      residual[row + 1] = foam_lateral_stress(terms, point.axial_stretch, point.lateral_stretch) / scale;
    }
    return 0;
  }
};

/// Slope of the stress and lateral contraction at the smallest strain: the first guess.
std::array<double, 2> small_strain(const std::vector<UniaxialPoint>& points) {
  const auto nearest = std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::abs(a.axial_stretch - 1.0) < std::abs(b.axial_stretch - 1.0);
  });
  const double strain = nearest->axial_stretch - 1.0;
  return {nearest->stress / strain, std::clamp(-(nearest->lateral_stretch - 1.0) / strain, -0.95, 0.48)};
}

} // namespace

double foam_axial_stress(const std::vector<FoamTerm>& terms, double axial, double lateral) {
  return stress(terms, axial, std::log(axial) + 2.0 * std::log(lateral));
}

double foam_lateral_stress(const std::vector<FoamTerm>& terms, double axial, double lateral) {
  return stress(terms, lateral, std::log(axial) + 2.0 * std::log(lateral));
}

FoamFit fit_foam(const std::vector<UniaxialPoint>& points, int n_terms) {
  if (n_terms < 1 || n_terms > 2 || 2 * static_cast<int>(points.size()) < 3 * n_terms) {
    throw std::invalid_argument(
        fmt::format("foam fit: terms = {} with {} points; 1 or 2 terms, two numbers a point and three a term "
                    "are allowed",
                    n_terms, points.size()));
  }
  const auto [young, poisson] = small_strain(points);
  const Misfit misfit{points, young, 3 * n_terms};
  // The misfit has several valleys in the exponents: the best of several starts.
  constexpr std::array<std::array<double, 2>, 7> starts{
      {{2, -4}, {2, -8}, {4, -2}, {8, 2}, {8, -8}, {-4, -12}, {1, 3}}};
  Eigen::VectorXd best;
  double best_square = std::numeric_limits<double>::infinity();
  for (const auto& exponents : starts) {
    Eigen::VectorXd x(3 * n_terms);
    for (int k = 0; k < n_terms; ++k) {
      x.segment<3>(3 * k) << std::log(0.5 / (1.0 + poisson) / n_terms), exponents[k],
          std::atanh((poisson + 0.25) / 0.75);
    }
    Eigen::NumericalDiff<Misfit, Eigen::Central> derivative(misfit);
    Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Misfit, Eigen::Central>> search(derivative);
    search.parameters.maxfev = 4000;
    search.parameters.ftol = search.parameters.xtol = 1e-14;
    search.minimize(x);
    if (search.fvec.squaredNorm() < best_square) {
      best_square = search.fvec.squaredNorm();
      best = x;
    }
  }
  if (best.size() == 0) {
    throw std::runtime_error("foam fit: no start gave a finite misfit");
  }
  FoamFit fit{.terms = terms_of(best, young)};
  Eigen::VectorXd residual(misfit.values());
  misfit(best, residual);
  double axial = 0.0, lateral = 0.0, largest = 0.0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    axial += std::pow(residual[2 * n] * young, 2) / points.size();
    lateral += std::pow(residual[2 * n + 1] * young, 2) / points.size();
    largest = std::max(largest, std::abs(points[n].stress));
  }
  fit.axial_residual = std::sqrt(axial) / largest;
  fit.lateral_residual = std::sqrt(lateral) / largest;
  return fit;
}

} // namespace boba::calibration
