// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/specimen/rigid_motions.h"

#include <Eigen/Geometry>
#include <cmath>

namespace boba::calibration {

using Eigen::Vector3d;

namespace {

double dot(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    sum += a[n].dot(b[n]);
  }
  return sum;
}

void subtract(std::vector<Vector3d>& from, double factor, const std::vector<Vector3d>& what) {
  for (std::size_t n = 0; n < from.size(); ++n) {
    from[n] -= factor * what[n];
  }
}

} // namespace

RigidMotions::RigidMotions(const std::vector<Vector3d>& position, const std::array<bool, 6>& chosen, int n_bodies) {
  const std::size_t size = position.size() / n_bodies;
  for (std::size_t first = 0; first < size * n_bodies; first += size) {
    Vector3d mean = Vector3d::Zero();
    for (std::size_t n = first; n < first + size; ++n) {
      mean += position[n] / static_cast<double>(size);
    }
    for (int m = 0; m < 6; ++m) {
      if (!chosen[m]) {
        continue;
      }
      std::vector<Vector3d> motion(position.size(), Vector3d::Zero());
      for (std::size_t n = first; n < first + size; ++n) {
        motion[n] = m < 3 ? Vector3d(Vector3d::Unit(m)) : Vector3d(Vector3d::Unit(m - 3).cross(position[n] - mean));
      }
      for (const auto& earlier : motion_) { // modified Gram-Schmidt
        subtract(motion, dot(motion, earlier), earlier);
      }
      const double length = std::sqrt(dot(motion, motion));
      for (Vector3d& v : motion) {
        v /= length;
      }
      motion_.push_back(std::move(motion));
    }
  }
}

void RigidMotions::take_out(std::vector<Vector3d>& field) const {
  for (const auto& motion : motion_) {
    subtract(field, dot(field, motion), motion);
  }
}

} // namespace boba::calibration
