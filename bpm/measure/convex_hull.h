// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

namespace boba::measure {

/// A convex hull as a closed triangle mesh with outward (counter-clockwise) triangles; vertices in the order of their
/// nodes, triangles sorted by vertices.
struct ConvexHull {
  std::vector<int> node;                     ///< per hull vertex: its number among the nodes that were given
  std::vector<Vector3> vertex;               ///< per hull vertex: its position, d
  std::vector<std::array<int, 3>> triangle;  ///< hull vertices
  std::vector<std::array<int, 3>> neighbour; ///< per triangle: the triangle across the edge (e, e + 1)

  int n_triangles() const { return static_cast<int>(triangle.size()); }
  /// Twice the area times the outward normal of triangle `t`, d^2.
  Vector3 area_vector(int t) const {
    const auto& [a, b, c] = triangle[t];
    return (vertex[b] - vertex[a]).cross(vertex[c] - vertex[a]);
  }
};

/// Convex hull of `nodes` with exact predicates; nodes that cannot be on it are skipped first (`hull_candidates`).
///
/// \param nodes positions, d; at least four that are not in one plane
/// \throws std::invalid_argument for fewer than four nodes, for nodes that all lie in one point, line or plane, and
/// for positions that are not finite.
/// Source: docs/notation.md, "Grain volume"; CGAL 3D Convex Hulls, kernel with exact predicates.
ConvexHull convex_hull(std::span<const Vector3> nodes);

/// The same without skipping any node: the oracle of `hull_candidates`.
ConvexHull convex_hull_of_all(std::span<const Vector3> nodes);

/// Numbers of the nodes that may be on the hull; every node left out is proven to be strictly inside it.
///
/// The hull of the extreme nodes along a fixed set of directions is a subset of the hull, so a node strictly inside
/// that polytope, by more than the rounding error of the test, is no hull vertex. Ascending.
std::vector<int> hull_candidates(std::span<const Vector3> nodes);

} // namespace boba::measure
