// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/near_centres.h"
#include "bpm/measure/neighbours.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::measure {

namespace {

/// The smallest m that satisfies the rule among sorted candidates that are complete up to `reach`; 0 when there is
/// none.
std::size_t solid_angle_number(const std::vector<NearCentre>& sorted, double reach) {
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

} // namespace

NeighbourLists solid_angle_neighbours(const Box& box, std::span<const Vector3> centres) {
  const NearCentres near(box, centres);
  NeighbourLists lists(centres.size());
  for (std::size_t grain = 0; grain < centres.size(); ++grain) {
    std::vector<NearCentre> sorted;
    std::size_t m = 0;
    double reach = 2.0 * near.spacing();
    while (m == 0) {
      if (reach > 10.0 * near.span()) {
        throw std::invalid_argument(fmt::format("neighbours: grain {} has no four grains around it", grain));
      }
      sorted = near.within(static_cast<int>(grain), reach);
      m = solid_angle_number(sorted, reach);
      reach *= 1.5;
    }
    for (std::size_t k = 0; k < m; ++k) {
      lists[grain].push_back({sorted[k].grain, sorted[k].vector, 1.0});
    }
  }
  return lists;
}

NeighbourLists nearest_neighbours(const Box& box, std::span<const Vector3> centres, int n) {
  const NearCentres near(box, centres);
  NeighbourLists lists(centres.size());
  for (std::size_t grain = 0; grain < centres.size(); ++grain) {
    std::vector<NearCentre> sorted;
    for (double reach = 2.0 * near.spacing(); static_cast<int>(sorted.size()) < n && reach <= 10.0 * near.span();
         reach *= 1.5) {
      sorted = near.within(static_cast<int>(grain), reach);
    }
    sorted.resize(std::min(sorted.size(), static_cast<std::size_t>(n)));
    for (const NearCentre& other : sorted) {
      lists[grain].push_back({other.grain, other.vector, 1.0});
    }
  }
  return lists;
}

} // namespace boba::measure
