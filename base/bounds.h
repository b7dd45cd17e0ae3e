// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

namespace boba {

/// Cuboid along the axes, for instance around a grain's nodes. Contains nothing until a point is included.
struct Bounds {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300);
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-1e300);

  void include(const Eigen::Vector3d& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  Eigen::Vector3d extent() const { return high - low; }
  /// False also when x is no number.
  bool contains(const Eigen::Vector3d& x) const {
    return (x.array() >= low.array()).all() && (x.array() <= high.array()).all();
  }
  Bounds widened(double by) const {
    return {low - Eigen::Vector3d::Constant(by), high + Eigen::Vector3d::Constant(by)};
  }
  template <class Visit> void for_each_corner(Visit&& visit) const {
    for (int corner = 0; corner < 8; ++corner) {
      Eigen::Vector3d x;
      for (int axis = 0; axis < 3; ++axis) {
        x[axis] = (corner >> axis & 1) != 0 ? high[axis] : low[axis];
      }
      visit(x);
    }
  }
  /// Of this cuboid's image. \param map affine: a point to a point
  template <class Map> Bounds mapped(const Map& map) const {
    Bounds result;
    for_each_corner([&](const Eigen::Vector3d& x) { result.include(map(x)); });
    return result;
  }
};

/// The smallest cuboid around the points.
inline Bounds bounds_of(std::span<const Eigen::Vector3d> points) {
  Bounds bounds;
  for (const Eigen::Vector3d& x : points) {
    bounds.include(x);
  }
  return bounds;
}

} // namespace boba
