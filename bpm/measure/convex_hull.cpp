// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/convex_hull.h"

#include "bpm/measure/farthest_nodes.h"

#include <CGAL/Convex_hull_traits_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/convex_hull_3.h>
#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>

namespace boba::measure {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Traits = CGAL::Convex_hull_traits_3<Kernel>;

Point to_point(const Vector3& x) {
  return Point(x[0], x[1], x[2]);
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
  // Sorted by x alone, with the number beside it: equal x are rare.
  std::vector<std::pair<double, int>> order(selected.size());
  std::transform(selected.begin(), selected.end(), order.begin(), [&](int i) { return std::pair(nodes[i][0], i); });
  std::sort(order.begin(), order.end());
  std::vector<int> found(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    auto at = std::lower_bound(order.begin(), order.end(), std::pair(vertices[v][0], 0));
    while (nodes[at->second] != vertices[v]) {
      ++at;
    }
    found[v] = at->second;
  }
  return found;
}

/// Neighbours across edges: half edges are listed by their lower vertex, where few candidates wait for each.
std::vector<std::array<int, 3>> adjacency(const std::vector<std::array<int, 3>>& triangles, std::size_t n_vertices) {
  struct HalfEdge {
    int high, triangle, edge;
  };
  std::vector<int> first(n_vertices + 1, 0);
  const int n = static_cast<int>(triangles.size());
  for (int i = 0; i < 3 * n; ++i) {
    ++first[std::min(triangles[i / 3][i % 3], triangles[i / 3][(i % 3 + 1) % 3]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<HalfEdge> waiting(3 * triangles.size());
  std::vector<int> n_waiting(n_vertices, 0);
  std::vector<std::array<int, 3>> neighbour(triangles.size());
  for (int i = 0; i < 3 * n; ++i) {
    const int t = i / 3, e = i % 3;
    const int low = std::min(triangles[t][e], triangles[t][(e + 1) % 3]);
    const int high = std::max(triangles[t][e], triangles[t][(e + 1) % 3]);
    HalfEdge* const begin = waiting.data() + first[low];
    HalfEdge* const end = begin + n_waiting[low];
    HalfEdge* const other = std::find_if(begin, end, [high](const HalfEdge& w) { return w.high == high; });
    if (other == end) {
      *end = {high, t, e};
      ++n_waiting[low];
    } else {
      neighbour[t][e] = other->triangle;
      neighbour[other->triangle][other->edge] = t;
    }
  }
  return neighbour;
}

void turn_outward(const std::vector<Point>& vertices, std::vector<std::array<int, 3>>& tetrahedron) {
  for (auto& [a, b, c] : tetrahedron) {
    const int opposite = 0 + 1 + 2 + 3 - a - b - c;
    if (CGAL::orientation(vertices[a], vertices[b], vertices[c], vertices[opposite]) == CGAL::POSITIVE) {
      std::swap(b, c);
    }
  }
}

/// Vertices in the order of their nodes, each triangle from its lowest vertex, triangles sorted: the order in which
/// CGAL hands them over follows addresses in memory, and sums over it would differ in their last digit from run to run.
void sort_mesh(ConvexHull& hull) {
  const std::size_t n = hull.vertex.size();
  std::vector<int> order(n), place(n), node(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return hull.node[a] < hull.node[b]; });
  std::vector<Vector3> vertex(n);
  for (std::size_t k = 0; k < n; ++k) {
    place[order[k]] = static_cast<int>(k);
    node[k] = hull.node[order[k]];
    vertex[k] = hull.vertex[order[k]];
  }
  hull.node = std::move(node);
  hull.vertex = std::move(vertex);
  for (std::array<int, 3>& triangle : hull.triangle) {
    std::transform(triangle.begin(), triangle.end(), triangle.begin(), [&](int v) { return place[v]; });
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  }
  std::sort(hull.triangle.begin(), hull.triangle.end());
}

ConvexHull hull_of_selected(std::span<const Vector3> nodes, const std::vector<int>& selected) {
  std::vector<Point> points(selected.size());
  std::transform(selected.begin(), selected.end(), points.begin(), [&](int i) { return to_point(nodes[i]); });
  check_dimension(points);
  // The traits are named: the overload without them (CGAL 5.5) takes the kernel itself, whose planes are *constructed*
  // in double; nearly coplanar nodes then give wrong hulls or a crash. With these a plane is three exact points.
  std::vector<Point> vertices;
  ConvexHull hull;
  CGAL::convex_hull_3<std::vector<Point>::const_iterator, Point>(points.begin(), points.end(), vertices, hull.triangle,
                                                                 Traits());
  if (hull.triangle.size() == 4) {
    turn_outward(vertices, hull.triangle); // CGAL 5.5 may return the four faces of a tetrahedron inside out
  }
  hull.vertex.reserve(vertices.size());
  for (const Point& p : vertices) {
    hull.vertex.emplace_back(p.x(), p.y(), p.z());
  }
  hull.node = find_nodes(nodes, selected, hull.vertex);
  sort_mesh(hull);
  hull.neighbour = adjacency(hull.triangle, hull.vertex.size());
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

/// A node that reaches farthest, for each direction; ascending, each once.
std::vector<int> extreme_nodes(std::span<const Vector3> nodes, const std::vector<Vector3>& directions) {
  std::vector<int> extreme = farthest_nodes(nodes, directions);
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
  static const std::vector<Vector3> directions = sphere_directions(32);
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
