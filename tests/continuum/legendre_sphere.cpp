// SPDX-License-Identifier: GPL-3.0-or-later
#include "legendre_sphere.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

namespace boba::continuum::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Nodes and weights of the Gauss-Legendre rule on (0, 1).
void gauss(int n, VectorXd& x, VectorXd& w) {
  x.resize(n);
  w.resize(n);
  for (int i = 0; i < n; ++i) {
    double t = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1;
    for (int step = 0; step < 100; ++step) {
      double before = 1, now = t;
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * t * now - (k - 1) * before) / k;
        before = now;
        now = next;
      }
      slope = n * (t * now - before) / (t * t - 1);
      const double change = now / slope;
      t -= change;
      if (std::abs(change) < 1e-15) {
        break;
      }
    }
    x[i] = 0.5 * (1 - t);
    w[i] = 1 / ((1 - t * t) * slope * slope);
  }
}

/// Compliance of harmonic n (G = 1): columns are the radial and tangential displacement under unit radial and
/// tangential traction, tractions s P_n and t dP_n/dtheta, displacements U P_n and V dP_n/dtheta.
Eigen::Matrix2d compliance(double n, double nu) {
  Eigen::Matrix2d traction, displacement;
  traction << (n + 1) * (n * n - n - 2 - 2 * nu), n * (n - 1), n * n + 2 * n - 1 + 2 * nu, n - 1;
  displacement << (n + 1) * (n - 2 + 4 * nu), n, n + 5 - 4 * nu, 1;
  if (n == 0) {
    Eigen::Matrix2d breathing = Eigen::Matrix2d::Zero();
    breathing(0, 0) = displacement(0, 0) / (2 * traction(0, 0));
    return breathing;
  }
  return displacement * traction.inverse() / 2;
}

} // namespace

LegendreSphere legendre_sphere(double poisson, double a, LegendreOrder order) {
  const int n_points = int(order.order) + 40;
  const int n_tests = order.terms + 1;
  VectorXd x, w;
  gauss(n_points, x, w);
  // r = a sin(psi) makes the square root at the edge smooth; area element sin(theta) d theta = r dr / cos(theta).
  VectorXd r(n_points), cosine(n_points), area(n_points);
  MatrixXd phi(n_points, n_tests);
  for (int i = 0; i < n_points; ++i) {
    const double psi = 0.5 * std::numbers::pi * x[i];
    const double s = std::sin(psi);
    r[i] = a * s;
    cosine[i] = std::sqrt(1 - r[i] * r[i]);
    area[i] = 0.5 * std::numbers::pi * w[i] * a * std::cos(psi) * r[i] / cosine[i];
    double before = 0, now = 1;
    for (int k = 0; k < n_tests; ++k) {
      phi(i, k) = std::cos(psi) * now;
      const double next = ((2 * k + 1) * (2 * s * s - 1) * now - k * before) / (k + 1);
      before = now;
      now = next;
    }
  }
  const MatrixXd radial = (area.cwiseProduct(cosine)).asDiagonal() * phi;
  const MatrixXd tangential = (area.cwiseProduct(r)).asDiagonal() * phi;
  MatrixXd lift = MatrixXd::Zero(n_tests, n_tests);
  VectorXd before = VectorXd::Zero(n_points), p = VectorXd::Ones(n_points);
  MatrixXd half = lift;
  const int last = int(order.order / a);
  for (int n = 0; n <= last; ++n) {
    if (n == last / 2) {
      half = lift;
    }
    if (n % 2 == 0) {
      // dP_n/dtheta = -n (P_{n-1} - cos P_n) / sin
      const VectorXd slope = (-n * (before - cosine.cwiseProduct(p))).cwiseQuotient(r);
      const VectorXd alpha = radial.transpose() * p;
      const VectorXd beta = tangential.transpose() * slope;
      const Eigen::Matrix2d c = compliance(n, poisson);
      // Traction -p z at both poles: radial -p cos, tangential +p sin; only even harmonics are left, twice.
      const VectorXd s = -(2 * n + 1) * alpha;
      const VectorXd t = n == 0 ? VectorXd::Zero(n_tests) : VectorXd((2 * n + 1) / (n * (n + 1.)) * beta);
      lift += alpha * (c(0, 0) * s + c(0, 1) * t).transpose() - beta * (c(1, 0) * s + c(1, 1) * t).transpose();
    }
    const VectorXd next = ((2 * n + 1) * cosine.cwiseProduct(p) - n * before) / (n + 1);
    before = p;
    p = next;
  }
  // The rest of the sum falls like N^-3: its mean is extrapolated away.
  lift += (lift - half) / 7;
  lift *= 2 * (1 + poisson); // E = 1: G = 1 / (2 (1 + nu))
  MatrixXd system(n_tests, n_tests);
  system.leftCols(order.terms) = lift.leftCols(order.terms);
  const VectorXd weight = phi.transpose() * area;
  system.col(order.terms) = weight;
  const VectorXd rhs = phi.transpose() * (area.cwiseProduct(VectorXd::Ones(n_points) - cosine));
  const VectorXd solution = system.fullPivLu().solve(rhs);
  LegendreSphere result{};
  result.approach = solution[order.terms];
  for (int k = 0; k < order.terms; ++k) {
    result.force += 2 * std::numbers::pi * weight[k] * solution[k];
    result.central_pressure += solution[k] * (k % 2 == 0 ? 1 : -1);
  }
  return result;
}

} // namespace boba::continuum::testing
