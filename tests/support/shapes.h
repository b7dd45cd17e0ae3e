// SPDX-License-Identifier: GPL-3.0-or-later
// Point sets whose hulls, areas and volumes are known in closed form.
#pragma once

#include "bpm/packing/box.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace boba::shapes {

/// Corners (+-1, +-1, +-1).
inline std::vector<Vector3> cube() {
  std::vector<Vector3> points;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        points.emplace_back(x, y, z);
      }
    }
  }
  return points;
}

/// Voronoi cell of fcc: 8 cube corners and 6 tips (+-2, 0, 0); 12 rhombic faces; volume 16, area 24 sqrt(2).
inline std::vector<Vector3> rhombic_dodecahedron() {
  std::vector<Vector3> points = cube();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-2.0, 2.0}) {
      points.push_back(sign * Vector3::Unit(axis));
    }
  }
  return points;
}

/// Voronoi cell of bcc: the permutations of (0, +-1, +-2); edge sqrt(2); 14 faces; volume 32, area 12 + 24 sqrt(3).
inline std::vector<Vector3> truncated_octahedron() {
  std::vector<Vector3> points;
  for (int zero = 0; zero < 3; ++zero) {
    for (const double one : {-1.0, 1.0}) {
      for (const double two : {-2.0, 2.0}) {
        for (const int turn : {1, 2}) {
          Vector3 x = Vector3::Zero();
          x[(zero + turn) % 3] = one;
          x[(zero + 3 - turn) % 3] = two;
          points.push_back(x);
        }
      }
    }
  }
  return points;
}

/// Evenly spread points on a sphere.
inline std::vector<Vector3> sphere_surface(int n, double radius) {
  std::vector<Vector3> points(n);
  for (int i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n;
    const double r = std::sqrt(1.0 - z * z), angle = std::numbers::pi * (3.0 - std::sqrt(5.0)) * i;
    points[i] = radius * Vector3(r * std::cos(angle), r * std::sin(angle), z);
  }
  return points;
}

/// Random points in a ball, uniform.
inline std::vector<Vector3> ball(int n, double radius, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> coordinate(-radius, radius);
  std::vector<Vector3> points;
  while (static_cast<int>(points.size()) < n) {
    const Vector3 x(coordinate(generator), coordinate(generator), coordinate(generator));
    if (x.squaredNorm() < radius * radius) {
      points.push_back(x);
    }
  }
  return points;
}

/// A rotation that is along no axis.
inline Matrix3 some_rotation() {
  return (Eigen::AngleAxisd(0.7, Vector3(1.0, -2.0, 0.5).normalized()) *
          Eigen::AngleAxisd(1.9, Vector3(0.3, 0.4, 1.0).normalized()))
      .toRotationMatrix();
}

inline std::vector<Vector3> moved(std::vector<Vector3> points, const Matrix3& rotation, const Vector3& shift) {
  for (Vector3& x : points) {
    x = rotation * x + shift;
  }
  return points;
}

/// A sphere's surface with caps beyond planes n . x = h removed; the rims are filled with points on their circles.
/// The circles must not meet. No sphere point stays so near a plane that its triangle would count as part of the disc.
inline std::vector<Vector3> cut_sphere(int n, double radius, const std::vector<Vector3>& normals, double height,
                                       int n_rim) {
  std::vector<Vector3> points;
  for (const Vector3& x : sphere_surface(n, radius)) {
    bool kept = true;
    for (const Vector3& normal : normals) {
      kept = kept && normal.dot(x) < height - 0.02 * radius;
    }
    if (kept) {
      points.push_back(x);
    }
  }
  const double rim = std::sqrt(radius * radius - height * height);
  for (const Vector3& normal : normals) {
    const Vector3 u = normal.unitOrthogonal(), v = normal.cross(u);
    for (int i = 0; i < n_rim; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / n_rim;
      points.push_back(height * normal + rim * (std::cos(angle) * u + std::sin(angle) * v));
    }
  }
  return points;
}

} // namespace boba::shapes
