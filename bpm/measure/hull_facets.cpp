// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/hull_facets.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <queue>
#include <stdexcept>

namespace boba::measure {

namespace {

struct TriangleGeometry {
  std::vector<Vector3> normal; ///< unit; zero for a triangle without area, which then joins nothing
  std::vector<double> area;
};

TriangleGeometry triangle_geometry(const ConvexHull& hull) {
  TriangleGeometry geometry;
  for (int t = 0; t < hull.n_triangles(); ++t) {
    const Vector3 vector = hull.area_vector(t);
    const double length = vector.norm();
    geometry.normal.push_back(length > 0.0 ? Vector3(vector / length) : Vector3(Vector3::Zero()));
    geometry.area.push_back(0.5 * length);
  }
  return geometry;
}

void check(const FacetOptions& options) {
  if (!(options.min_cosine > -1.0 && options.min_cosine < 1.0)) {
    throw std::invalid_argument(
        fmt::format("facets: min_cosine is {}; it must lie between -1 and 1", options.min_cosine));
  }
  if (!(options.min_area_share >= 0.0 && options.min_area_share < 1.0)) {
    throw std::invalid_argument(
        fmt::format("facets: min_area_share is {}; it must be at least 0 and below 1", options.min_area_share));
  }
}

/// Facets from groups of triangles, numbered by descending area.
Facets make_facets(std::vector<std::vector<int>> groups, const TriangleGeometry& geometry) {
  const auto group_area = [&](const std::vector<int>& group) {
    return std::accumulate(group.begin(), group.end(), 0.0, [&](double sum, int t) { return sum + geometry.area[t]; });
  };
  std::stable_sort(groups.begin(), groups.end(),
                   [&](const auto& a, const auto& b) { return group_area(a) > group_area(b); });
  Facets facets;
  facets.hull_area = std::accumulate(geometry.area.begin(), geometry.area.end(), 0.0);
  facets.facet_of_triangle.assign(geometry.area.size(), -1);
  for (const std::vector<int>& group : groups) {
    Vector3 mean = Vector3::Zero();
    for (const int t : group) {
      facets.facet_of_triangle[t] = facets.n_facets();
      mean += geometry.area[t] * geometry.normal[t];
    }
    facets.area.push_back(group_area(group));
    facets.normal.push_back(mean.normalized());
  }
  return facets;
}

/// Grows the region of one seed at a time over triangles that are still free.
class RegionGrower {
public:
  RegionGrower(const ConvexHull& hull, const TriangleGeometry& geometry, double min_cosine)
      : hull_(hull), geometry_(geometry), min_cosine_(min_cosine), taken_(hull.n_triangles(), 0),
        visited_(hull.n_triangles(), -1) {}

  bool is_taken(int t) const { return taken_[t] != 0; }
  void take(const std::vector<int>& region) {
    for (const int t : region) {
      taken_[t] = 1;
    }
  }

  /// The free triangles connected to `seed` whose normals are near the seed's; `area()` is then theirs.
  const std::vector<int>& region_of(int seed) {
    ++visit_;
    region_.assign(1, seed);
    visited_[seed] = visit_;
    area_ = geometry_.area[seed];
    const Vector3 normal = geometry_.normal[seed];
    for (std::size_t i = 0; i < region_.size(); ++i) {
      for (const int next : hull_.neighbour[region_[i]]) {
        if (visited_[next] != visit_ && !is_taken(next) && geometry_.normal[next].dot(normal) > min_cosine_) {
          visited_[next] = visit_;
          area_ += geometry_.area[next];
          region_.push_back(next);
        }
      }
    }
    return region_;
  }
  double area() const { return area_; }

private:
  const ConvexHull& hull_;
  const TriangleGeometry& geometry_;
  double min_cosine_;
  std::vector<char> taken_;
  std::vector<int> visited_;
  std::vector<int> region_;
  int visit_ = -1;
  double area_ = 0.0;
};

} // namespace

double Facets::faceted_share() const {
  return hull_area > 0.0 ? std::accumulate(area.begin(), area.end(), 0.0) / hull_area : 0.0;
}

Facets transitive_facets(const ConvexHull& hull, const FacetOptions& options) {
  check(options);
  const TriangleGeometry geometry = triangle_geometry(hull);
  std::vector<char> visited(hull.n_triangles(), 0);
  std::vector<std::vector<int>> groups;
  for (int start = 0; start < hull.n_triangles(); ++start) {
    if (visited[start]) {
      continue;
    }
    visited[start] = 1;
    std::vector<int> group = {start};
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (const int next : hull.neighbour[group[i]]) {
        if (!visited[next] && geometry.normal[next].dot(geometry.normal[group[i]]) > options.min_cosine) {
          visited[next] = 1;
          group.push_back(next);
        }
      }
    }
    if (group.size() > 1) {
      groups.push_back(std::move(group));
    }
  }
  return make_facets(std::move(groups), geometry);
}

Facets grown_facets(const ConvexHull& hull, const FacetOptions& options) {
  check(options);
  const TriangleGeometry geometry = triangle_geometry(hull);
  const double min_area = options.min_area_share * std::accumulate(geometry.area.begin(), geometry.area.end(), 0.0);
  RegionGrower grower(hull, geometry, options.min_cosine);
  // A region can only shrink as triangles are taken, so an area in the queue is an upper bound: the entry on top is
  // grown again and accepted when it still leads. Ties go to the lower triangle number.
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry> queue;
  for (int t = 0; t < hull.n_triangles(); ++t) {
    grower.region_of(t);
    if (grower.area() >= min_area) { // the others can only shrink
      queue.emplace(grower.area(), -t);
    }
  }
  std::vector<std::vector<int>> groups;
  while (!queue.empty()) {
    const int seed = -queue.top().second;
    queue.pop();
    if (grower.is_taken(seed)) {
      continue;
    }
    const std::vector<int>& region = grower.region_of(seed);
    const Entry now{grower.area(), -seed};
    if (queue.empty() || now >= queue.top()) {
      if (now.first >= min_area) {
        groups.push_back(region);
        grower.take(region);
      }
    } else if (now.first >= min_area) {
      queue.push(now);
    }
  }
  return make_facets(std::move(groups), geometry);
}

} // namespace boba::measure
