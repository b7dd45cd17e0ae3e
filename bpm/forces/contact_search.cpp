// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/contact_search.h"

#include <algorithm>
#include <cmath>

namespace boba {

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

/// The places of a grid's nodes near a point, in some of its rows.
class NearPlaces {
public:
  NearPlaces(const GrainGrid& grid, double radius)
      : kernel_(kernels::best_table().near_places), columns_(grid.columns()), radius2_(radius * radius) {}

  void add_row(std::int32_t begin, std::int32_t end) {
    rows_.push_back({begin, end});
    n_places_ += end - begin;
  }
  /// Those in the rows that were added since the last time.
  std::span<const std::int32_t> find(const Vector3& x) {
    const auto room = static_cast<std::size_t>(n_places_) + kernels::near_padding;
    if (found_.size() < room) {
      found_.resize(room);
    }
    const std::int32_t n =
        kernel_(columns_, rows_.data(), static_cast<int>(rows_.size()), x.data(), radius2_, found_.data());
    rows_.clear();
    n_places_ = 0;
    return std::span(found_).first(n);
  }

private:
  decltype(kernels::KernelTable::near_places) kernel_;
  kernels::SortedNodes columns_;
  double radius2_;
  std::int32_t n_places_ = 0;
  // Scratch of the thread: whoever looks up a single node asks for no memory.
  inline static thread_local std::vector<kernels::PlaceRange> rows_;
  inline static thread_local std::vector<std::int32_t> found_;
};

} // namespace

Gap gap_between(const GrainGrid& a, const GrainFrame& frame_a, const GrainGrid& b, const GrainFrame& frame_b) {
  constexpr double rounding = 1e-4; // of a place's component in single precision, up to hundreds of d from the centre
  const Vector3 line = frame_b.centre - frame_a.centre;
  const double distance = line.norm();
  if (!(distance > 0.0)) {
    return {};
  }
  const Vector3 n = line / distance;
  return {n, n.dot(frame_a.centre) + a.extent(frame_a.linear.transpose() * n) + rounding,
          n.dot(frame_b.centre) - b.extent(-(frame_b.linear.transpose() * n)) - rounding};
}

void add_pairs_between(const GrainGrid& a, const GrainGrid& b, const GrainFrame& b_to_a, double radius,
                       std::vector<kernels::NodePair>& pairs) {
  const Vector3 margin = Vector3::Constant(radius);
  // Inserted places of a may be one cell outside its bounds.
  const Bounds region = a.bounds().widened(radius + a.reach()).mapped(b_to_a.inverse());
  NearPlaces near(a, radius);
  const auto add = [&](std::int32_t j, const Vector3& place) {
    const Vector3 x = b_to_a(place);
    if (!a.near(x)) {
      return;
    }
    for_each_row(a, cells_around(a, x - margin, x + margin),
                 [&](std::int32_t first, std::int32_t last) { near.add_row(first, last); });
    for (const std::int32_t i : near.find(x)) {
      pairs.push_back({a.node(i), j});
    }
    a.visit_inserted(x, radius, [&](std::int32_t i) { pairs.push_back({i, j}); });
  };
  for_each_row(b, cells_around(b, region.low, region.high), [&](std::int32_t begin, std::int32_t end) {
    for (std::int32_t place = begin; place < end; ++place) {
      add(b.node(place), b.position(place));
    }
  });
  b.for_each_inserted(add);
}

namespace {

/// Where the partners of the node at place `at` of cell (x, y, z) are, among the half of the surrounding cells that
/// come later: the rest of its row, and the rows after.
void add_later_rows(const GrainGrid& grid, std::int32_t at, int x, int y, int z, NearPlaces& near) {
  const int left = std::max(x - 1, 0), right = std::min(x + 2, grid.cells(0));
  near.add_row(at + 1, grid.begin(right, y, z));
  if (y + 1 < grid.cells(1)) {
    near.add_row(grid.begin(left, y + 1, z), grid.begin(right, y + 1, z));
  }
  if (z + 1 < grid.cells(2)) {
    for (int row = std::max(y - 1, 0); row < std::min(y + 2, grid.cells(1)); ++row) {
      near.add_row(grid.begin(left, row, z + 1), grid.begin(right, row, z + 1));
    }
  }
}

} // namespace

void add_pairs_inside(const GrainGrid& grid, const NetworkData& network, double radius,
                      std::vector<kernels::NodePair>& pairs) {
  std::vector<std::int32_t> bonded_to(grid.size(), -1);
  NearPlaces near(grid, radius);
  for (int z = 0; z < grid.cells(2); ++z) {
    for (int y = 0; y < grid.cells(1); ++y) {
      for (int x = 0; x < grid.cells(0); ++x) {
        for (std::int32_t at = grid.begin(x, y, z); at < grid.begin(x + 1, y, z); ++at) {
          const std::int32_t i = grid.node(at);
          for (const std::int32_t* j = network.partners_begin(i); j != network.partners_end(i); ++j) {
            bonded_to[*j] = i;
          }
          add_later_rows(grid, at, x, y, z, near);
          for (const std::int32_t place : near.find(grid.position(at))) {
            const std::int32_t j = grid.node(place);
            if (bonded_to[j] != i) {
              pairs.push_back({std::min(i, j), std::max(i, j)});
            }
          }
        }
      }
    }
  }
}

void add_nodes_near(const GrainGrid& grid, const Vector3& x, double radius, std::vector<std::int32_t>& nodes) {
  if (!grid.near(x)) {
    return;
  }
  const Vector3 margin = Vector3::Constant(radius);
  NearPlaces near(grid, radius);
  for_each_row(grid, cells_around(grid, x - margin, x + margin),
               [&](std::int32_t begin, std::int32_t end) { near.add_row(begin, end); });
  for (const std::int32_t place : near.find(x)) {
    nodes.push_back(grid.node(place));
  }
  grid.visit_inserted(x, radius, [&](std::int32_t node) { nodes.push_back(node); });
}

} // namespace boba
