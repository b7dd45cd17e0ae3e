// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/convex_hull.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>
#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

namespace boba::measure {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

Point to_point(const Vector3& x) {
  return Point(x[0], x[1], x[2]);
}

bool before(const Vector3& a, const Vector3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

void check_finite(std::span<const Vector3> nodes) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].allFinite()) {
      throw std::invalid_argument(fmt::format("convex hull: node {} is at ({}, {}, {}); positions must be finite", i,
                                              nodes[i][0], nodes[i][1], nodes[i][2]));
    }
  }
}

/// Dimension (0 to 3) of the affine span of the points, by exact predicates.
int affine_dimension(const std::vector<Point>& points) {
  const Point& a = points.front();
  const auto b = std::find_if(points.begin(), points.end(), [&](const Point& p) { return p != a; });
  if (b == points.end()) {
    return 0;
  }
  const auto c = std::find_if(b, points.end(), [&](const Point& p) { return !CGAL::collinear(a, *b, p); });
  if (c == points.end()) {
    return 1;
  }
  const bool flat = std::all_of(c, points.end(), [&](const Point& p) { return CGAL::coplanar(a, *b, *c, p); });
  return flat ? 2 : 3;
}

void check_dimension(const std::vector<Point>& points) {
  if (points.size() < 4) {
    throw std::invalid_argument(
        fmt::format("convex hull: {} nodes have no volume; at least 4 are needed", points.size()));
  }
  const int dimension = affine_dimension(points);
  if (dimension < 3) {
    constexpr std::array where = {"in one point", "on one line", "in one plane"};
    throw std::invalid_argument(fmt::format("convex hull: all {} nodes lie {}; a hull needs four that do not",
                                            points.size(), where[dimension]));
  }
}

/// For each vertex the number of a node at exactly its position (the lowest, when nodes coincide).
std::vector<int> find_nodes(std::span<const Vector3> nodes, const std::vector<int>& selected,
                            const std::vector<Vector3>& vertices) {
  std::vector<int> order = selected;
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return before(nodes[i], nodes[j]); });
  std::vector<int> found(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    found[v] = *std::lower_bound(order.begin(), order.end(), vertices[v],
                                 [&](int i, const Vector3& x) { return before(nodes[i], x); });
  }
  return found;
}

/// Neighbours across edges from the sorted list of half edges.
std::vector<std::array<int, 3>> adjacency(const std::vector<std::array<int, 3>>& triangles) {
  struct HalfEdge {
    int low, high, triangle, edge;
  };
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int e = 0; e < 3; ++e) {
      const auto [low, high] = std::minmax(triangles[t][e], triangles[t][(e + 1) % 3]);
      edges.push_back({low, high, t, e});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const HalfEdge& a, const HalfEdge& b) { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
  std::vector<std::array<int, 3>> neighbour(triangles.size());
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    CGAL_assertion(edges[i].low == edges[i + 1].low && edges[i].high == edges[i + 1].high);
    neighbour[edges[i].triangle][edges[i].edge] = edges[i + 1].triangle;
    neighbour[edges[i + 1].triangle][edges[i + 1].edge] = edges[i].triangle;
  }
  return neighbour;
}

ConvexHull hull_of_selected(std::span<const Vector3> nodes, const std::vector<int>& selected) {
  std::vector<Point> points(selected.size());
  std::transform(selected.begin(), selected.end(), points.begin(), [&](int i) { return to_point(nodes[i]); });
  check_dimension(points);
  // Into a Surface_mesh, not into plain vectors: that overload (CGAL 5.5) takes the kernel itself as its traits, whose
  // planes are *constructed* in double; nearly coplanar nodes then give wrong hulls or a crash.
  CGAL::Surface_mesh<Point> mesh;
  CGAL::convex_hull_3(points.begin(), points.end(), mesh);
  ConvexHull hull;
  hull.vertex.reserve(mesh.number_of_vertices());
  for (const auto v : mesh.vertices()) {
    const Point& p = mesh.point(v);
    hull.vertex.emplace_back(p.x(), p.y(), p.z());
  }
  hull.triangle.reserve(mesh.number_of_faces());
  for (const auto face : mesh.faces()) {
    std::array<int, 3> corners{};
    int n = 0;
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(face))) {
      corners.at(n++) = static_cast<int>(v.idx());
    }
    hull.triangle.push_back(corners);
  }
  hull.node = find_nodes(nodes, selected, hull.vertex);
  hull.neighbour = adjacency(hull.triangle);
  return hull;
}

std::vector<int> all_of(std::span<const Vector3> nodes) {
  std::vector<int> all(nodes.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Points spread evenly over the unit sphere (a spiral with the golden angle).
std::vector<Vector3> sphere_directions(int n) {
  const double golden_angle = 3.141592653589793 * (3.0 - std::sqrt(5.0));
  std::vector<Vector3> directions(n);
  for (int i = 0; i < n; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / n;
    const double r = std::sqrt(1.0 - z * z);
    directions[i] = {r * std::cos(golden_angle * i), r * std::sin(golden_angle * i), z};
  }
  return directions;
}

/// The lowest-numbered node that reaches farthest, for each direction; ascending, each once.
std::vector<int> extreme_nodes(std::span<const Vector3> nodes, const std::vector<Vector3>& directions) {
  std::vector<int> extreme(directions.size());
  for (std::size_t k = 0; k < directions.size(); ++k) {
    double farthest = nodes[0].dot(directions[k]);
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const double reach = nodes[i].dot(directions[k]);
      if (reach > farthest) {
        farthest = reach;
        extreme[k] = static_cast<int>(i);
      }
    }
  }
  std::sort(extreme.begin(), extreme.end());
  extreme.erase(std::unique(extreme.begin(), extreme.end()), extreme.end());
  return extreme;
}

/// Half spaces n . x < offset whose intersection is proven to be strictly inside a polytope.
struct InnerHalfSpaces {
  std::vector<Vector3> normal;
  std::vector<double> offset;
  Vector3 centre = Vector3::Zero();
  double inner_radius = 0.0; ///< the ball around the centre within all half spaces
};

/// Shrinks every face of `hull` by a bound of the rounding error of its plane and of the later test.
InnerHalfSpaces inner_half_spaces(const ConvexHull& hull, double magnitude, double extent) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  InnerHalfSpaces inner;
  inner.centre = std::accumulate(hull.vertex.begin(), hull.vertex.end(), Vector3(Vector3::Zero())) /
                 static_cast<double>(hull.vertex.size());
  inner.inner_radius = std::numeric_limits<double>::infinity();
  for (int t = 0; t < hull.n_triangles(); ++t) {
    const auto& [a, b, c] = hull.triangle[t];
    const Vector3 scaled_normal = hull.area_vector(t);
    const double length = scaled_normal.norm();
    const double edges = (hull.vertex[b] - hull.vertex[a]).norm() + (hull.vertex[c] - hull.vertex[a]).norm();
    // An edge vector is off by up to epsilon * magnitude a component, so the unit normal turns by up to
    // ~ epsilon * magnitude * edges / length, and a point `extent` away shifts by that times extent. Slivers
    // (length -> 0) get a huge margin: they then exclude nothing, which is safe.
    const double margin = 16.0 * epsilon * magnitude * (1.0 + edges * extent / length);
    const Vector3 normal = scaled_normal / length;
    const double offset = normal.dot(hull.vertex[a]) - margin;
    if (!std::isfinite(offset)) {
      return {};
    }
    inner.normal.push_back(normal);
    inner.offset.push_back(offset);
    inner.inner_radius = std::min(inner.inner_radius, offset - normal.dot(inner.centre));
  }
  return inner;
}

bool is_inside(const InnerHalfSpaces& inner, const Vector3& x) {
  // (1 - 1e-9) covers the rounding of this distance; nodes that fail it go through the half spaces.
  if ((x - inner.centre).norm() < inner.inner_radius * (1.0 - 1e-9)) {
    return true;
  }
  for (std::size_t k = 0; k < inner.normal.size(); ++k) {
    if (inner.normal[k].dot(x) >= inner.offset[k]) {
      return false;
    }
  }
  return !inner.normal.empty();
}

} // namespace

std::vector<int> hull_candidates(std::span<const Vector3> nodes) {
  static const std::vector<Vector3> directions = sphere_directions(96);
  if (nodes.size() < 2 * directions.size()) {
    return all_of(nodes);
  }
  const std::vector<int> extreme = extreme_nodes(nodes, directions);
  std::vector<Point> points(extreme.size());
  std::transform(extreme.begin(), extreme.end(), points.begin(), [&](int i) { return to_point(nodes[i]); });
  if (points.size() < 4 || affine_dimension(points) < 3) {
    return all_of(nodes);
  }
  Eigen::AlignedBox3d bounds;
  for (const Vector3& x : nodes) {
    bounds.extend(x);
  }
  const double magnitude = std::max(bounds.min().cwiseAbs().maxCoeff(), bounds.max().cwiseAbs().maxCoeff());
  const InnerHalfSpaces inner =
      inner_half_spaces(hull_of_selected(nodes, extreme), magnitude, bounds.diagonal().norm());
  std::vector<int> candidates;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!is_inside(inner, nodes[i])) {
      candidates.push_back(static_cast<int>(i));
    }
  }
  return candidates;
}

ConvexHull convex_hull(std::span<const Vector3> nodes) {
  check_finite(nodes);
  return hull_of_selected(nodes, hull_candidates(nodes));
}

ConvexHull convex_hull_of_all(std::span<const Vector3> nodes) {
  check_finite(nodes);
  return hull_of_selected(nodes, all_of(nodes));
}

} // namespace boba::measure
