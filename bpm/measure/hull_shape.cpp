// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/hull_shape.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace boba::measure {

namespace {

/// Moments of the solid about `origin`: volume, first moment, second moment.
struct SolidMoments {
  double volume = 0.0;
  Vector3 first = Vector3::Zero();
  Matrix3 second = Matrix3::Zero();
};

SolidMoments solid_moments(const ConvexHull& hull, const Vector3& origin) {
  SolidMoments sum;
  for (const auto& [ia, ib, ic] : hull.triangle) {
    const Vector3 a = hull.vertex[ia] - origin, b = hull.vertex[ib] - origin, c = hull.vertex[ic] - origin;
    const double volume = a.dot(b.cross(c)) / 6.0;
    const Vector3 total = a + b + c;
    sum.volume += volume;
    sum.first += volume / 4.0 * total;
    sum.second +=
        volume / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + total * total.transpose());
  }
  return sum;
}

} // namespace

HullShape hull_shape(const ConvexHull& hull) {
  if (hull.vertex.empty()) {
    throw std::invalid_argument("hull shape: the hull has no vertices");
  }
  // From an inner point: no cancellation when the grain is far from the origin.
  const Vector3 inner = std::accumulate(hull.vertex.begin(), hull.vertex.end(), Vector3(Vector3::Zero())) /
                        static_cast<double>(hull.vertex.size());
  const SolidMoments moments = solid_moments(hull, inner);
  HullShape shape;
  shape.volume = moments.volume;
  if (!(shape.volume > 0.0)) {
    throw std::invalid_argument("hull shape: the hull has no volume");
  }
  for (int t = 0; t < hull.n_triangles(); ++t) {
    shape.area += 0.5 * hull.area_vector(t).norm();
  }
  shape.asphericity = std::pow(shape.area, 1.5) / (6.0 * std::sqrt(std::numbers::pi) * shape.volume);
  const Vector3 offset = moments.first / shape.volume;
  shape.centroid = inner + offset;
  const Matrix3 covariance = moments.second / shape.volume - offset * offset.transpose();
  const Matrix3 inertia = covariance.trace() * Matrix3::Identity() - covariance;
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(inertia);
  shape.moments = solver.eigenvalues();
  shape.axes = solver.eigenvectors();
  if (shape.axes.determinant() < 0.0) {
    shape.axes.col(2) *= -1.0;
  }
  return shape;
}

} // namespace boba::measure
