// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/contact/pressure_profile.h"

#include <Eigen/QR>
#include <cmath>

namespace boba::continuum {
namespace {

/// Weighted points of a fit.
struct Samples {
  std::vector<double> x, y, weight;

  void add(double at, double value, double w) {
    x.push_back(at);
    y.push_back(value);
    weight.push_back(w);
  }
  std::size_t size() const { return x.size(); }

  /// Coefficients of the polynomial in x of the given degree that fits y best.
  Eigen::VectorXd polynomial(int degree) const {
    const auto n = Eigen::Index(size());
    Eigen::MatrixXd powers(n, degree + 1);
    Eigen::VectorXd rhs(n);
    for (std::size_t i = 0; i < size(); ++i) {
      const double root = std::sqrt(weight[i]);
      rhs[Eigen::Index(i)] = root * y[i];
      for (int k = 0; k <= degree; ++k) {
        powers(Eigen::Index(i), k) = root * std::pow(x[i], k);
      }
    }
    return powers.colPivHouseholderQr().solve(rhs);
  }
};

} // namespace

double extrapolated_edge(const std::vector<ProfilePoint>& points, double margin, double innermost) {
  if (points.empty()) {
    return 0;
  }
  const double last = points.back().r;
  Samples samples;
  for (const auto& [r, pressure, weight] : points) {
    if (r >= innermost * last && r < last - margin) {
      samples.add(r * r, pressure * pressure, weight);
    }
  }
  if (samples.size() < 5) {
    return last;
  }
  const Eigen::VectorXd fit = samples.polynomial(2);
  double square = last * last;
  for (int step = 0; step < 20; ++step) {
    square -= (fit[0] + square * (fit[1] + square * fit[2])) / (fit[1] + 2 * square * fit[2]);
  }
  // The edge lies beside the last pressed node; a fit that says otherwise is not one.
  const double edge = std::sqrt(std::max(0., square));
  return std::abs(edge - last) < 2 * margin ? edge : last;
}

double pressure_on_axis(const std::vector<ProfilePoint>& points, double edge) {
  Samples samples;
  for (const auto& [r, pressure, weight] : points) {
    if (r >= 0.5 * edge && samples.size() >= 3) {
      break;
    }
    samples.add(r * r, pressure, weight);
  }
  return samples.size() == 0 ? 0 : samples.polynomial(samples.size() > 5 ? 2 : 1)[0];
}

} // namespace boba::continuum
