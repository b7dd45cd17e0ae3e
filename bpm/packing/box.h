// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace boba {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// A triclinic cell: a = (Lx, 0, 0), b = (xy, Ly, 0), c = (xz, yz, Lz) with its corner at `origin`.
///
/// Lengths in d. The matrix `h()` has a, b, c as its columns, so x = origin + h s with fractional coordinates s.
/// Positions in the engine are *unwrapped*: a grain is never torn, and an image is x + h n with integers n.
/// Source: docs/notation.md, "Box".
class Box {
public:
  Box() = default;
  /// \throws std::invalid_argument unless all three lengths are positive and finite.
  Box(const Vector3& origin, const Vector3& lengths, const Vector3& tilts_xy_xz_yz = Vector3::Zero(),
      std::array<bool, 3> periodic = {true, true, true});

  const Vector3& origin() const { return origin_; }
  const Matrix3& h() const { return h_; }
  const Matrix3& h_inverse() const { return h_inverse_; }
  const std::array<bool, 3>& periodic() const { return periodic_; }
  double volume() const { return h_(0, 0) * h_(1, 1) * h_(2, 2); }
  Vector3 lengths() const { return h_.diagonal(); }
  double xy() const { return h_(0, 1); }
  double xz() const { return h_(0, 2); }
  double yz() const { return h_(1, 2); }

  Vector3 to_fractional(const Vector3& x) const { return h_inverse_ * (x - origin_); }
  Vector3 to_position(const Vector3& s) const { return origin_ + h_ * s; }
  /// Integers n such that x - h n lies in the cell (zero along directions that are not periodic).
  Eigen::Vector3i image_of(const Vector3& x) const;
  Vector3 wrapped(const Vector3& x) const { return x - h_ * image_of(x).cast<double>(); }
  /// Difference vector shortened by rounding its fractional coordinates. It is the nearest image as long as the
  /// result is shorter than half of the smallest distance between opposite faces.
  Vector3 minimum_image(const Vector3& difference) const;
  /// Distances between opposite faces (a, b, c directions), d.
  Vector3 face_distances() const;

  /// Replaces the cell matrix (upper triangular, positive diagonal); the origin stays.
  void set_h(const Matrix3& h);
  /// Brings |xy| <= Lx/2, |yz| <= Ly/2 and |xz| <= Lx/2 by adding lattice vectors to b and c: the same lattice, other
  /// cell vectors. Returns true when anything changed. Unwrapped positions and forces do not change.
  bool flip();

private:
  Vector3 origin_ = Vector3::Zero();
  Matrix3 h_ = Matrix3::Identity();
  Matrix3 h_inverse_ = Matrix3::Identity();
  std::array<bool, 3> periodic_ = {true, true, true};
};

} // namespace boba
