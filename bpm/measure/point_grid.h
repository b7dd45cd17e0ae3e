// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace boba::measure {

/// Points of a (triclinic, partly periodic) cell sorted into a grid, to visit all that are near something.
///
/// Cells are slices of the fractional coordinates, so they tilt with the box. Points must lie in the cell along its
/// periodic directions; along the others they may lie anywhere and are kept in the outermost cells.
class PointGrid {
public:
  /// \param cell_width smallest distance between opposite faces of a grid cell, d
  PointGrid(const Box& box, std::span<const Vector3> points, double cell_width);

  /// Calls visit(point, image) for each point image whose grid cell meets the range low..high of fractional
  /// coordinates: `image` is the position of that periodic copy. The range may extend beyond the cell; each image is
  /// visited once.
  template <class Visit> void visit_range(const Vector3& low, const Vector3& high, const Visit& visit) const {
    std::array<int, 3> first{}, last{};
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = cell_index(axis, low[axis]);
      last[axis] = cell_index(axis, high[axis]);
    }
    for (int c2 = first[2]; c2 <= last[2]; ++c2) {
      const auto [i2, k2] = split(2, c2);
      for (int c1 = first[1]; c1 <= last[1]; ++c1) {
        const auto [i1, k1] = split(1, c1);
        for (int c0 = first[0]; c0 <= last[0]; ++c0) {
          const auto [i0, k0] = split(0, c0);
          const std::size_t cell = (static_cast<std::size_t>(i2) * n_cells_[1] + i1) * n_cells_[0] + i0;
          if (start_[cell] == start_[cell + 1]) {
            continue;
          }
          const Vector3 shift = box_.h() * Vector3(k0, k1, k2);
          for (std::int64_t p = start_[cell]; p < start_[cell + 1]; ++p) {
            visit(order_[p], Vector3(points_[order_[p]] + shift));
          }
        }
      }
    }
  }

  /// The same for all points within `radius` of `x`, and some more.
  template <class Visit> void visit_near(const Vector3& x, double radius, const Visit& visit) const {
    const Vector3 s = box_.to_fractional(x), reach = radius * inverse_face_distance_;
    visit_range(s - reach, s + reach, visit);
  }

private:
  /// Grid index along an axis; beyond the cell it counts on where the axis is periodic and stops where it is not.
  int cell_index(int axis, double s) const;
  /// {index within the cell, periodic image}.
  std::array<int, 2> split(int axis, int index) const {
    const int n = n_cells_[axis];
    const int image = index >= 0 ? index / n : -((n - 1 - index) / n);
    return {index - image * n, image};
  }

  Box box_;
  std::span<const Vector3> points_;
  Vector3 inverse_face_distance_ = Vector3::Zero();
  std::array<int, 3> n_cells_{};
  std::vector<std::int64_t> start_; ///< per cell: range in order_
  std::vector<std::int64_t> order_; ///< point numbers, cell by cell
};

} // namespace boba::measure
