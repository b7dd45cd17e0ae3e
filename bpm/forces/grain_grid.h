// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/bounds.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/packing/box.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace boba {

/// All nodes of one grain in cubic cells of edge `reach` over its bounds, sorted by cell with x running fastest, so
/// that the cells of a row are one run of nodes. No assumption is made on which nodes are at the surface. Coordinates
/// are kept as floats.
class GrainGrid {
public:
  GrainGrid() = default;
  GrainGrid(std::span<const Vector3> nodes, const Bounds& bounds, double reach);

  const Bounds& bounds() const { return bounds_; }
  double reach() const { return reach_; }
  std::int32_t size() const { return static_cast<std::int32_t>(node_.size()); }
  int cells(int axis) const { return n_cells_[axis]; }
  /// Place in the sorted order of the first node of cell (x, y, z); x may be cells(0), the end of the row.
  std::int32_t begin(int x, int y, int z) const {
    return first_[(static_cast<std::int64_t>(z) * n_cells_[1] + y) * n_cells_[0] + x];
  }
  /// Cell coordinate along an axis, not limited to the grid.
  int coordinate(double x, int axis) const {
    return static_cast<int>(std::floor((x - bounds_.low[axis]) * inverse_cell_));
  }
  int inside(int coordinate, int axis) const { return std::clamp(coordinate, 0, n_cells_[axis] - 1); }
  /// False when none of the 27 cells around the one that holds x has a node, inserted ones included.
  bool near(const Vector3& x) const;
  /// Adds a place where a node is seen too, at most one cell outside the bounds. The sorted nodes stay as they are.
  void insert(std::int32_t node, const Vector3& position);
  /// Calls visit(node, place) for every inserted place.
  template <class Visit> void for_each_inserted(Visit&& visit) const {
    for (const Inserted& inserted : inserted_) {
      visit(inserted.node, inserted.position);
    }
  }
  /// Calls visit(node) for the inserted places closer than `radius` (at most the reach) to x.
  template <class Visit> void visit_inserted(const Vector3& x, double radius, Visit&& visit) const {
    if (inserted_.empty()) {
      return;
    }
    int c[3];
    for (int axis = 0; axis < 3; ++axis) {
      c[axis] = coordinate(x[axis], axis);
    }
    for (int z = std::max(c[2] - 1, -ring); z <= std::min(c[2] + 1, n_cells_[2] + ring - 1); ++z) {
      for (int y = std::max(c[1] - 1, -ring); y <= std::min(c[1] + 1, n_cells_[1] + ring - 1); ++y) {
        for (int x_cell = std::max(c[0] - 1, -ring); x_cell <= std::min(c[0] + 1, n_cells_[0] + ring - 1); ++x_cell) {
          for (std::int32_t at = last_inserted_[ringed(x_cell, y, z)]; at >= 0; at = inserted_[at].previous) {
            if ((inserted_[at].position - x).squaredNorm() < radius * radius) {
              visit(inserted_[at].node);
            }
          }
        }
      }
    }
  }

  /// Largest X . direction of all places, inserted ones included; in single precision.
  float extent(const Vector3& direction) const;

  std::int32_t node(std::int32_t place) const { return node_[place]; }
  Vector3 position(std::int32_t place) const { return {x_[place], y_[place], z_[place]}; }
  kernels::SortedNodes columns() const { return {x_.data(), y_.data(), z_.data()}; }
  std::size_t bytes() const {
    return (first_.capacity() + node_.capacity()) * sizeof(std::int32_t) + 3 * x_.capacity() * sizeof(float) +
           near_.capacity() + last_inserted_.capacity() * sizeof(std::int32_t) +
           inserted_.capacity() * sizeof(Inserted);
  }

private:
  /// Cells around the grid on each side: an inserted place may be in the first, whoever is near it in the second.
  static constexpr int ring = 2;

  struct Inserted {
    Vector3 position;
    std::int32_t node, previous; ///< `previous`: the one inserted into the same cell before, or -1
  };

  std::int64_t ringed(int x, int y, int z) const {
    return (static_cast<std::int64_t>(z + ring) * (n_cells_[1] + 2 * ring) + y + ring) * (n_cells_[0] + 2 * ring) + x +
           ring;
  }
  void mark_around(int x, int y, int z);

  Bounds bounds_;
  double reach_ = 1.0, inverse_cell_ = 1.0;
  int n_cells_[3] = {0, 0, 0};
  std::vector<std::int32_t> first_;
  std::vector<std::int32_t> node_;
  std::vector<float> x_, y_, z_;
  std::vector<std::uint8_t> near_;          ///< over the cells and the rings around them
  std::vector<std::int32_t> last_inserted_; ///< over the same, or empty
  std::vector<Inserted> inserted_;
};

} // namespace boba
