// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/packing_fraction.h"

#include "base/bounds.h"
#include "bpm/measure/parallel_loop.h"
#include "bpm/measure/philox.h"
#include "bpm/measure/point_grid.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace boba::measure {

namespace {

constexpr std::int64_t points_per_batch = std::int64_t{1} << 20;

void check(const GrainNodes& grains, std::span<const ConvexHull> hulls, const PackingFractionOptions& options) {
  if (options.n_points < 1) {
    throw std::invalid_argument(
        fmt::format("packing fraction: n_points is {}; it must be at least 1", options.n_points));
  }
  constexpr double least_error = 1e-5; // three thousand million points
  if (options.target_error && !(*options.target_error >= least_error && *options.target_error <= 0.5)) {
    throw std::invalid_argument(fmt::format("packing fraction: target_error is {}; it must lie between {} and 0.5",
                                            *options.target_error, least_error));
  }
  if (!(options.node_diameter >= 0.0) || !std::isfinite(options.node_diameter)) {
    throw std::invalid_argument(
        fmt::format("packing fraction: node_diameter is {}; it must be zero or positive", options.node_diameter));
  }
  if (!hulls.empty() && static_cast<int>(hulls.size()) != grains.n_grains()) {
    throw std::invalid_argument(fmt::format("packing fraction: {} hulls for {} grains; give one a grain or none",
                                            hulls.size(), grains.n_grains()));
  }
}

/// A hull as half spaces, for the point-in-hull test.
struct HullPlanes {
  std::vector<Vector3> normal;
  std::vector<double> offset;
  Vector3 centre = Vector3::Zero();
  double inner_radius_squared = 0.0;
  Bounds fractional; ///< in units of the cell

  HullPlanes(const ConvexHull& hull, const Box& box) {
    for (const Vector3& x : hull.vertex) {
      centre += x / static_cast<double>(hull.vertex.size());
      fractional.include(box.to_fractional(x));
    }
    double inner_radius = std::numeric_limits<double>::infinity();
    for (int t = 0; t < hull.n_triangles(); ++t) {
      const Vector3 vector = hull.area_vector(t);
      if (vector.norm() > 0.0) {
        normal.push_back(vector.normalized());
        offset.push_back(normal.back().dot(hull.vertex[hull.triangle[t][0]]));
        inner_radius = std::min(inner_radius, offset.back() - normal.back().dot(centre));
      }
    }
    inner_radius_squared = inner_radius > 0.0 ? inner_radius * inner_radius : 0.0;
  }

  bool contains(const Vector3& x) const {
    if ((x - centre).squaredNorm() < inner_radius_squared) {
      return true;
    }
    for (std::size_t k = 0; k < normal.size(); ++k) {
      if (normal[k].dot(x) > offset[k]) {
        return false;
      }
    }
    return true;
  }
};

/// What a set of points hit. Several grains may mark the same point at once: all write the same value.
struct Marks {
  explicit Marks(std::size_t n) : in_node(n, 0), in_hull(n, 0) {}
  static void set(char& mark) { std::atomic_ref(mark).store(1, std::memory_order_relaxed); }
  std::vector<char> in_node, in_hull;
};

struct Hits {
  std::int64_t both = 0, nodes = 0, hulls = 0, points = 0;
};

Hits count(const Marks& marks) {
  Hits hits;
  for (std::size_t p = 0; p < marks.in_node.size(); ++p) {
    hits.nodes += marks.in_node[p];
    hits.hulls += marks.in_hull[p];
    hits.both += (marks.in_node[p] | marks.in_hull[p]);
  }
  hits.points = static_cast<std::int64_t>(marks.in_node.size());
  return hits;
}

Share share(std::int64_t hits, std::int64_t points) {
  const double n = static_cast<double>(points);
  const double smoothed = (static_cast<double>(hits) + 1.0) / (n + 2.0);
  return {static_cast<double>(hits) / n, std::sqrt(smoothed * (1.0 - smoothed) / n)};
}

class Sampler {
public:
  Sampler(const Box& box, const GrainNodes& grains, std::span<const ConvexHull> hulls,
          const PackingFractionOptions& options, const Ranks& ranks)
      : box_(box), grains_(grains), seed_(options.seed), radius_(0.5 * options.node_diameter),
        items_(ranks, grains.n_grains()) {
    for (const ConvexHull& hull : hulls) {
      planes_.emplace_back(hull, box);
    }
  }

  /// Draws points until there are `n` in total.
  void draw_to(std::int64_t n) {
    while (hits_.points < n) {
      const Hits batch = draw(hits_.points, std::min(n - hits_.points, points_per_batch));
      hits_.both += batch.both;
      hits_.nodes += batch.nodes;
      hits_.hulls += batch.hulls;
      hits_.points += batch.points;
    }
  }

  PackingFraction result() const {
    return {share(hits_.both, hits_.points), share(hits_.nodes, hits_.points), share(hits_.hulls, hits_.points),
            hits_.points};
  }

private:
  Hits draw(std::int64_t first, std::int64_t n) const {
    std::vector<Vector3> points(n);
    for (std::int64_t p = 0; p < n; ++p) {
      const auto u = random_point(seed_, static_cast<std::uint64_t>(first + p));
      points[p] = box_.to_position({u[0], u[1], u[2]});
    }
    const PointGrid grid(box_, points, std::max(2.0 * radius_, 1e-3 * std::cbrt(box_.volume())));
    Marks marks(points.size());
    parallel_loop(items_, [&](std::int64_t grain) { mark(static_cast<int>(grain), grid, marks); });
    items_.ranks().any(marks.in_node);
    items_.ranks().any(marks.in_hull);
    return count(marks);
  }

  void mark(int grain, const PointGrid& grid, Marks& marks) const {
    if (!planes_.empty() && !planes_[grain].normal.empty()) {
      const HullPlanes& planes = planes_[grain];
      grid.visit_range(planes.fractional.low, planes.fractional.high, [&](std::int64_t p, const Vector3& image) {
        if (planes.contains(image)) {
          Marks::set(marks.in_hull[p]);
        }
      });
    }
    for (const Vector3& x : grains_.nodes_of(grain)) {
      grid.visit_near(x, radius_, [&](std::int64_t p, const Vector3& image) {
        if ((image - x).squaredNorm() <= radius_ * radius_) {
          Marks::set(marks.in_node[p]);
        }
      });
    }
  }

  const Box& box_;
  const GrainNodes& grains_;
  std::uint64_t seed_;
  double radius_;
  DealtItems items_;
  std::vector<HullPlanes> planes_;
  Hits hits_;
};

} // namespace

PackingFraction packing_fraction(const Box& box, const GrainNodes& grains, std::span<const ConvexHull> hulls,
                                 const PackingFractionOptions& options, const Ranks& ranks) {
  check(grains, hulls, options);
  Sampler sampler(box, grains, hulls, options, ranks);
  if (!options.target_error) {
    sampler.draw_to(options.n_points);
    return sampler.result();
  }
  sampler.draw_to(std::min<std::int64_t>(options.n_points, 10000));
  while (sampler.result().both.standard_error > *options.target_error) {
    // The error falls as 1/sqrt(n); 2 % more, since p is only known to its own error.
    const PackingFraction now = sampler.result();
    const double ratio = now.both.standard_error / *options.target_error;
    sampler.draw_to(static_cast<std::int64_t>(1.02 * ratio * ratio * static_cast<double>(now.n_points)) + 1);
  }
  return sampler.result();
}

double reference_packing_fraction(const Box& box, std::span<const double> reference_volumes) {
  return std::accumulate(reference_volumes.begin(), reference_volumes.end(), 0.0) / box.volume();
}

} // namespace boba::measure
