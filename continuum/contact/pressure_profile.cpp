// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/contact/pressure_profile.h"

#include <Eigen/QR>
#include <cmath>

namespace boba::continuum {
namespace {

/// Coefficients of the polynomial in x of the given degree that fits y best.
Eigen::VectorXd polynomial_fit(const std::vector<double>& x, const std::vector<double>& y, int degree) {
  Eigen::MatrixXd powers(Eigen::Index(x.size()), degree + 1);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int k = 0; k <= degree; ++k) {
      powers(Eigen::Index(i), k) = std::pow(x[i], k);
    }
  }
  return powers.colPivHouseholderQr().solve(Eigen::Map<const Eigen::VectorXd>(y.data(), Eigen::Index(y.size())));
}

} // namespace

double extrapolated_edge(const std::vector<ProfilePoint>& points, double margin) {
  if (points.empty()) {
    return 0;
  }
  const double last = points.back().r;
  std::vector<double> squares, pressures;
  for (const auto& [r, pressure] : points) {
    if (r > 0.6 * last && r < last - margin) {
      squares.push_back(r * r);
      pressures.push_back(pressure * pressure);
    }
  }
  if (squares.size() < 5) {
    return last;
  }
  const Eigen::VectorXd fit = polynomial_fit(squares, pressures, 2);
  double square = last * last;
  for (int step = 0; step < 20; ++step) {
    square -= (fit[0] + square * (fit[1] + square * fit[2])) / (fit[1] + 2 * square * fit[2]);
  }
  // The edge lies beside the last pressed node; a fit that says otherwise is not one.
  const double edge = std::sqrt(std::max(0., square));
  return std::abs(edge - last) < 2 * margin ? edge : last;
}

double pressure_on_axis(const std::vector<ProfilePoint>& points, double edge) {
  std::vector<double> squares, pressures;
  for (const auto& [r, pressure] : points) {
    if (r >= 0.5 * edge && squares.size() >= 3) {
      break;
    }
    squares.push_back(r * r);
    pressures.push_back(pressure);
  }
  return squares.empty() ? 0 : polynomial_fit(squares, pressures, squares.size() > 5 ? 2 : 1)[0];
}

} // namespace boba::continuum
