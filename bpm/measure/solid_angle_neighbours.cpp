// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/neighbours.h"
#include "bpm/measure/point_grid.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <stdexcept>

namespace boba::measure {

namespace {

struct Candidate {
  double distance = 0.0;
  int grain = 0;
  Vector3 vector;
  bool operator<(const Candidate& other) const { return distance < other.distance; }
};

/// The smallest m that satisfies the rule among sorted candidates that are complete up to `reach`; 0 when there is
/// none.
std::size_t solid_angle_number(const std::vector<Candidate>& sorted, double reach) {
  double sum = 0.0;
  for (std::size_t m = 1; m <= sorted.size(); ++m) {
    sum += sorted[m - 1].distance;
    const double next = m < sorted.size() ? sorted[m].distance : reach;
    if (m >= 3 && sum / (static_cast<double>(m) - 2.0) <= next) {
      return m;
    }
  }
  return 0;
}

std::vector<Candidate> candidates_within(const PointGrid& grid, std::span<const Vector3> centres, int grain,
                                         double reach) {
  std::vector<Candidate> found;
  grid.visit_near(centres[grain], reach, [&](std::int64_t other, const Vector3& image) {
    const Vector3 vector = image - centres[grain];
    const double distance = vector.norm();
    if (distance > reach) {
      return;
    }
    // The grain itself sits at rounding distance; its periodic copies are far.
    if (distance < 1e-9 * reach) {
      if (other != grain) {
        throw std::invalid_argument(fmt::format("neighbours: grains {} and {} have the same centre", grain, other));
      }
      return;
    }
    found.push_back({distance, static_cast<int>(other), vector});
  });
  std::sort(found.begin(), found.end());
  return found;
}

} // namespace

NeighbourLists solid_angle_neighbours(const Box& box, std::span<const Vector3> centres) {
  if (centres.empty()) {
    throw std::invalid_argument("neighbours: there are no grains");
  }
  std::vector<Vector3> wrapped(centres.size());
  std::transform(centres.begin(), centres.end(), wrapped.begin(), [&](const Vector3& x) { return box.wrapped(x); });
  const double spacing = std::cbrt(box.volume() / static_cast<double>(centres.size()));
  const double span = box.h().colwise().norm().sum();
  const PointGrid grid(box, wrapped, spacing);
  NeighbourLists lists(centres.size());
  for (std::size_t grain = 0; grain < centres.size(); ++grain) {
    std::vector<Candidate> sorted;
    std::size_t m = 0;
    double reach = 2.0 * spacing;
    while (m == 0) {
      if (reach > 10.0 * span) {
        throw std::invalid_argument(fmt::format("neighbours: grain {} has no four grains around it", grain));
      }
      sorted = candidates_within(grid, wrapped, static_cast<int>(grain), reach);
      m = solid_angle_number(sorted, reach);
      reach *= 1.5;
    }
    for (std::size_t k = 0; k < m; ++k) {
      lists[grain].push_back({sorted[k].grain, sorted[k].vector, 1.0});
    }
  }
  return lists;
}

} // namespace boba::measure
