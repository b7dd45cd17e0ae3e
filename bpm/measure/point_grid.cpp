// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/point_grid.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::measure {

PointGrid::PointGrid(const Box& box, std::span<const Vector3> points, double cell_width) : box_(box), points_(points) {
  if (!(cell_width > 0.0)) {
    throw std::invalid_argument(fmt::format("point grid: cell width is {}; it must be positive", cell_width));
  }
  const Vector3 distance = box.face_distances();
  inverse_face_distance_ = distance.cwiseInverse();
  // Not many more cells than points: a dilute box needs no finer grid.
  const double limit = std::cbrt(4.0 * static_cast<double>(points.size()) + 64.0);
  for (int axis = 0; axis < 3; ++axis) {
    const double share = distance[axis] / std::cbrt(distance.prod());
    n_cells_[axis] = static_cast<int>(std::clamp(distance[axis] / cell_width, 1.0, std::max(1.0, limit * share)));
  }
  std::vector<std::int64_t> cell_of(points.size());
  start_.assign(static_cast<std::size_t>(n_cells_[0]) * n_cells_[1] * n_cells_[2] + 1, 0);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vector3 s = box.to_fractional(points[p]);
    std::array<std::int64_t, 3> index{};
    for (int axis = 0; axis < 3; ++axis) {
      // A coordinate of exactly 1, or -1e-17, is rounding of a point in the cell.
      index[axis] = std::clamp<std::int64_t>(cell_index(axis, s[axis]), 0, n_cells_[axis] - 1);
    }
    cell_of[p] = (index[2] * n_cells_[1] + index[1]) * n_cells_[0] + index[0];
    ++start_[cell_of[p] + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) {
    start_[c] += start_[c - 1];
  }
  order_.resize(points.size());
  std::vector<std::int64_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t p = 0; p < points.size(); ++p) {
    order_[next[cell_of[p]]++] = static_cast<std::int64_t>(p);
  }
}

int PointGrid::cell_index(int axis, double s) const {
  const double index = std::floor(s * n_cells_[axis]);
  return static_cast<int>(box_.periodic()[axis] ? index : std::clamp(index, 0.0, n_cells_[axis] - 1.0));
}

} // namespace boba::measure
