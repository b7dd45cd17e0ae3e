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

namespace {

/// First and last cell along an axis that a point's neighbours can be in, within the grid.
struct CellRange {
  int from[3], to[3];
};

CellRange cells_around(const GrainGrid& grid, const Vector3& low, const Vector3& high) {
  CellRange range;
  for (int axis = 0; axis < 3; ++axis) {
    range.from[axis] = std::max(grid.coordinate(low[axis], axis), 0);
    range.to[axis] = std::min(grid.coordinate(high[axis], axis), grid.cells(axis) - 1);
  }
  return range;
}

/// Calls visit(begin, end) with the places of every row of cells in the range.
template <class Visit> void for_each_row(const GrainGrid& grid, const CellRange& range, Visit&& visit) {
  if (range.from[0] > range.to[0]) {
    return;
  }
  for (int z = range.from[2]; z <= range.to[2]; ++z) {
    for (int y = range.from[1]; y <= range.to[1]; ++y) {
      visit(grid.begin(range.from[0], y, z), grid.begin(range.to[0] + 1, y, z));
    }
  }
}

/// Collects the places of a grid's nodes near a point, row by row.
class NearPlaces {
public:
  NearPlaces(const GrainGrid& grid)
      : kernel_(kernels::best_table().near_places), columns_(grid.columns()), reach2_(grid.reach() * grid.reach()),
        found_(grid.size() + 8) {}

  void clear() { n_ = 0; }
  void add_row(std::int32_t begin, std::int32_t end, const Vector3& x) {
    n_ += kernel_(columns_, begin, end, x.data(), reach2_, found_.data() + n_);
  }
  std::span<const std::int32_t> places() const { return std::span(found_).first(n_); }

private:
  decltype(kernels::KernelTable::near_places) kernel_;
  kernels::SortedNodes columns_;
  double reach2_;
  std::vector<std::int32_t> found_;
  std::int32_t n_ = 0;
};

} // namespace

void add_pairs_between(const GrainGrid& own, const GrainGrid& other, const Vector3& shift, int neighbour,
                       std::vector<CandidatePair>& pairs) {
  const Vector3 margin = Vector3::Constant(own.reach());
  const CellRange overlap = cells_around(other, own.bounds().low - margin - shift, own.bounds().high + margin - shift);
  NearPlaces near(own);
  for_each_row(other, overlap, [&](std::int32_t begin, std::int32_t end) {
    for (std::int32_t theirs = begin; theirs < end; ++theirs) {
      const Vector3 x = other.position(theirs) + shift;
      if (!own.near(x)) {
        continue;
      }
      near.clear();
      for_each_row(own, cells_around(own, x - margin, x + margin),
                   [&](std::int32_t first, std::int32_t last) { near.add_row(first, last, x); });
      for (const std::int32_t ours : near.places()) {
        pairs.push_back({own.node(ours), neighbour, other.node(theirs)});
      }
    }
  });
}

namespace {

/// Unbonded partners of the node at place `at` of cell (x, y, z) among the half of the surrounding cells that come later:
/// the rest of its row, and the rows after.
void find_later(const GrainGrid& own, std::int32_t at, int x, int y, int z, NearPlaces& near) {
  const Vector3 position = own.position(at);
  const int left = std::max(x - 1, 0), right = std::min(x + 2, own.cells(0));
  near.clear();
  near.add_row(at + 1, own.begin(right, y, z), position);
  if (y + 1 < own.cells(1)) {
    near.add_row(own.begin(left, y + 1, z), own.begin(right, y + 1, z), position);
  }
  if (z + 1 < own.cells(2)) {
    for (int row = std::max(y - 1, 0); row < std::min(y + 2, own.cells(1)); ++row) {
      near.add_row(own.begin(left, row, z + 1), own.begin(right, row, z + 1), position);
    }
  }
}

} // namespace

void add_pairs_inside(const GrainGrid& own, const NetworkData& network, std::vector<CandidatePair>& pairs) {
  std::vector<std::int32_t> bonded_to(own.size(), -1);
  NearPlaces near(own);
  for (int z = 0; z < own.cells(2); ++z) {
    for (int y = 0; y < own.cells(1); ++y) {
      for (int x = 0; x < own.cells(0); ++x) {
        for (std::int32_t at = own.begin(x, y, z); at < own.begin(x + 1, y, z); ++at) {
          const std::int32_t i = own.node(at);
          for (const std::int32_t* j = network.partners_begin(i); j != network.partners_end(i); ++j) {
            bonded_to[*j] = i;
          }
          find_later(own, at, x, y, z, near);
          for (const std::int32_t place : near.places()) {
            const std::int32_t j = own.node(place);
            if (bonded_to[j] != i) {
              pairs.push_back({i, -1, j});
              pairs.push_back({j, -1, i});
            }
          }
        }
      }
    }
  }
}

void add_nodes_near(const GrainGrid& grid, const Vector3& x, std::vector<std::int32_t>& nodes) {
  if (!grid.near(x)) {
    return;
  }
  const Vector3 margin = Vector3::Constant(grid.reach());
  const auto find = kernels::best_table().near_places;
  for_each_row(grid, cells_around(grid, x - margin, x + margin), [&](std::int32_t begin, std::int32_t end) {
    const std::size_t before = nodes.size();
    nodes.resize(before + (end - begin) + 8);
    const std::int32_t n =
        find(grid.columns(), begin, end, x.data(), grid.reach() * grid.reach(), nodes.data() + before);
    nodes.resize(before + n);
    for (std::size_t k = before; k < nodes.size(); ++k) {
      nodes[k] = grid.node(nodes[k]);
    }
  });
  grid.visit_inserted(x, [&](std::int32_t node) { nodes.push_back(node); });
}

} // namespace boba
