// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/box.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

void check_lengths(const Matrix3& h) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(h(axis, axis) > 0.0) || !std::isfinite(h(axis, axis))) {
      throw std::invalid_argument(
          fmt::format("box: length along {} is {}; it must be positive and finite", "xyz"[axis], h(axis, axis)));
    }
  }
}

} // namespace

Box::Box(const Vector3& origin, const Vector3& lengths, const Vector3& tilts, std::array<bool, 3> periodic)
    : origin_(origin), periodic_(periodic) {
  Matrix3 h = lengths.asDiagonal();
  h(0, 1) = tilts[0];
  h(0, 2) = tilts[1];
  h(1, 2) = tilts[2];
  set_h(h);
}

void Box::set_h(const Matrix3& h) {
  check_lengths(h);
  h_ = h;
  // The inverse of an upper triangular 3x3 matrix, written out so that its zeros are exact.
  h_inverse_.setZero();
  for (int axis = 0; axis < 3; ++axis) {
    h_inverse_(axis, axis) = 1.0 / h(axis, axis);
  }
  h_inverse_(0, 1) = -h(0, 1) / (h(0, 0) * h(1, 1));
  h_inverse_(1, 2) = -h(1, 2) / (h(1, 1) * h(2, 2));
  h_inverse_(0, 2) = (h(0, 1) * h(1, 2) - h(0, 2) * h(1, 1)) / volume();
}

Eigen::Vector3i Box::image_of(const Vector3& x) const {
  const Vector3 s = to_fractional(x);
  Eigen::Vector3i n;
  for (int axis = 0; axis < 3; ++axis) {
    n[axis] = periodic_[axis] ? static_cast<int>(std::floor(s[axis])) : 0;
  }
  return n;
}

Vector3 Box::minimum_image(const Vector3& difference) const {
  const Vector3 s = h_inverse_ * difference;
  Vector3 n = Vector3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (periodic_[axis]) {
      n[axis] = std::round(s[axis]);
    }
  }
  return difference - h_ * n;
}

Vector3 Box::face_distances() const {
  // Row i of the inverse is the reciprocal vector of face pair i.
  return h_inverse_.rowwise().norm().cwiseInverse();
}

bool Box::flip() {
  Matrix3 h = h_;
  if (periodic_[1] && std::abs(h(1, 2)) > 0.5 * h(1, 1)) {
    h.col(2) -= std::round(h(1, 2) / h(1, 1)) * h.col(1);
  }
  if (periodic_[0]) {
    for (int column = 1; column < 3; ++column) {
      if (std::abs(h(0, column)) > 0.5 * h(0, 0)) {
        h(0, column) -= std::round(h(0, column) / h(0, 0)) * h(0, 0);
      }
    }
  }
  if (h == h_) {
    return false;
  }
  set_h(h);
  return true;
}

} // namespace boba
