// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <Eigen/LU>

namespace boba {

/// Where a grain is as a whole: an affine map x = linear X + centre from the places X of its nodes, noted once, to
/// space (d).
struct GrainFrame {
  Matrix3 linear = Matrix3::Identity();
  Vector3 centre = Vector3::Zero();

  Vector3 operator()(const Vector3& place) const { return linear * place + centre; }
  GrainFrame inverse() const {
    const Matrix3 back = linear.inverse();
    return {back, -back * centre};
  }
  /// First `inner`, then this one.
  GrainFrame after(const GrainFrame& inner) const { return {linear * inner.linear, linear * inner.centre + centre}; }
  GrainFrame displaced(const Vector3& shift) const { return {linear, centre + shift}; }
};

/// A bound e on how much a map shortens any vector: |(linear) v| >= (1 - e) |v|. Rotations shorten nothing.
///
/// With linear = I + L and s the norm of L's symmetric part, |v + L v|^2 >= (1 - 2 s) |v|^2, and sqrt(1 - 2 s) >= 1 - s
/// - s^2 for s <= 1/2.
inline double shortening(const Matrix3& linear) {
  const Matrix3 l = linear - Matrix3::Identity();
  const double s = 0.5 * (l + l.transpose()).norm();
  return s <= 0.5 ? s + s * s : 1.0;
}

} // namespace boba
