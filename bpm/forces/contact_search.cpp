// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/contact_search.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

/// Integers n with |offset + n period| <= reach; {0, 0} along a direction that is not periodic and within reach.
struct Interval {
  int first, last;
};

Interval images_within(double offset, double period, double reach, bool periodic) {
  if (!periodic) {
    return std::abs(offset) <= reach ? Interval{0, 0} : Interval{0, -1};
  }
  return {static_cast<int>(std::ceil((-reach - offset) / period)), static_cast<int>(std::floor((reach - offset) / period))};
}

} // namespace

std::vector<NeighbourGrain> neighbour_grains(int g, std::span<const Bounds> bounds, const Box& box, double reach) {
  std::vector<NeighbourGrain> found;
  const Matrix3& h = box.h();
  const auto& periodic = box.periodic();
  for (int other = 0; other < static_cast<int>(bounds.size()); ++other) {
    const Vector3 distance = 0.5 * (bounds[other].low + bounds[other].high - bounds[g].low - bounds[g].high);
    const Vector3 touching =
        (0.5 * (bounds[other].high - bounds[other].low + bounds[g].high - bounds[g].low)).array() + reach;
    const Interval c = images_within(distance[2], h(2, 2), touching[2], periodic[2]);
    for (int nc = c.first; nc <= c.last; ++nc) {
      const Interval b = images_within(distance[1] + nc * h(1, 2), h(1, 1), touching[1], periodic[1]);
      for (int nb = b.first; nb <= b.last; ++nb) {
        const double x = distance[0] + nb * h(0, 1) + nc * h(0, 2);
        const Interval a = images_within(x, h(0, 0), touching[0], periodic[0]);
        for (int na = a.first; na <= a.last; ++na) {
          if (other != g || na != 0 || nb != 0 || nc != 0) {
            found.push_back({other, {na, nb, nc}});
          }
        }
      }
    }
  }
  return found;
}

ContactSearch::ContactSearch(std::span<const Vector3> own, const Bounds& bounds, double reach)
    : own_(own), low_(bounds.low), reach_(reach), inverse_cell_(1.0 / reach) {
  inflated_.low = bounds.low.array() - reach;
  inflated_.high = bounds.high.array() + reach;
  std::int64_t n = 1;
  for (int axis = 0; axis < 3; ++axis) {
    n_cells_[axis] = 1 + static_cast<int>((bounds.high[axis] - bounds.low[axis]) * inverse_cell_);
    n *= n_cells_[axis];
  }
  first_.assign(n + 1, 0);
  std::vector<std::int32_t> cell(own.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    cell[i] = (cell_coordinate(own[i][2], 2) * n_cells_[1] + cell_coordinate(own[i][1], 1)) * n_cells_[0] +
              cell_coordinate(own[i][0], 0);
    ++first_[cell[i] + 1];
  }
  for (std::int64_t k = 0; k < n; ++k) {
    first_[k + 1] += first_[k];
  }
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  node_.resize(own.size());
  sorted_.resize(own.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    const std::int32_t at = next[cell[i]]++;
    node_[at] = static_cast<std::int32_t>(i);
    sorted_[at] = own[i];
  }
}

int ContactSearch::cell_coordinate(double x, int axis) const {
  return std::clamp(static_cast<int>((x - low_[axis]) * inverse_cell_), 0, n_cells_[axis] - 1);
}

/// Calls visit(own node) for every own node closer than the reach to x, which lies inside the inflated bounds.
template <class Visit> void ContactSearch::visit_near(const Vector3& x, Visit&& visit) const {
  int from[3], to[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int cell = static_cast<int>(std::floor((x[axis] - low_[axis]) * inverse_cell_));
    from[axis] = std::max(cell - 1, 0);
    to[axis] = std::min(cell + 1, n_cells_[axis] - 1);
  }
  const double reach2 = reach_ * reach_;
  for (int cz = from[2]; cz <= to[2]; ++cz) {
    for (int cy = from[1]; cy <= to[1]; ++cy) {
      // Cells along x are neighbours in memory: one run of nodes.
      const std::int64_t row = (static_cast<std::int64_t>(cz) * n_cells_[1] + cy) * n_cells_[0];
      for (std::int32_t k = first_[row + from[0]]; from[0] <= to[0] && k < first_[row + to[0] + 1]; ++k) {
        if ((sorted_[k] - x).squaredNorm() < reach2) {
          visit(node_[k]);
        }
      }
    }
  }
}

void ContactSearch::add_neighbour(int neighbour, std::span<const Vector3> other, const Vector3& shift,
                                  std::vector<CandidatePair>& pairs) const {
  const Vector3 low = inflated_.low - shift, high = inflated_.high - shift;
  for (std::size_t j = 0; j < other.size(); ++j) {
    const Vector3& x = other[j];
    const bool inside = (x[0] > low[0]) & (x[0] < high[0]) & (x[1] > low[1]) & (x[1] < high[1]) & (x[2] > low[2]) &
                        (x[2] < high[2]);
    if (inside) {
      visit_near(x + shift,
                 [&](std::int32_t i) { pairs.push_back({i, neighbour, static_cast<std::int32_t>(j)}); });
    }
  }
}

void ContactSearch::add_own(const NetworkData& network, std::vector<CandidatePair>& pairs) const {
  std::vector<std::int32_t> bonded_to(own_.size(), -1);
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(own_.size()); ++i) {
    for (const std::int32_t* j = network.partners_begin(i); j != network.partners_end(i); ++j) {
      bonded_to[*j] = i;
    }
    visit_near(own_[i], [&](std::int32_t j) {
      if (j > i && bonded_to[j] != i) {
        pairs.push_back({i, -1, j});
        pairs.push_back({j, -1, i});
      }
    });
  }
}

} // namespace boba
