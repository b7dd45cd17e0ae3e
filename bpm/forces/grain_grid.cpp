// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/grain_grid.h"

namespace boba {

GrainGrid::GrainGrid(std::span<const Vector3> nodes, const Bounds& bounds, double reach)
    : bounds_(bounds), reach_(reach), inverse_cell_(1.0 / reach), node_(nodes.size()),
      x_(nodes.size()), y_(nodes.size()), z_(nodes.size()) {
  std::int64_t n = 1, n_ringed = 1;
  for (int axis = 0; axis < 3; ++axis) {
    n_cells_[axis] = 1 + static_cast<int>((bounds.high[axis] - bounds.low[axis]) * inverse_cell_);
    n *= n_cells_[axis];
    n_ringed *= n_cells_[axis] + 2;
  }
  first_.assign(n + 1, 0);
  near_.assign(n_ringed, 0);
  std::vector<std::int32_t> cell(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    int c[3];
    for (int axis = 0; axis < 3; ++axis) {
      c[axis] = inside(coordinate(nodes[i][axis], axis), axis);
    }
    cell[i] = (c[2] * n_cells_[1] + c[1]) * n_cells_[0] + c[0];
    ++first_[cell[i] + 1];
  }
  const std::int64_t row = n_cells_[0] + 2, layer = row * (n_cells_[1] + 2);
  std::int64_t k = 0;
  for (int z = 0; z < n_cells_[2]; ++z) {
    for (int y = 0; y < n_cells_[1]; ++y) {
      for (int x = 0; x < n_cells_[0]; ++x, ++k) {
        if (first_[k + 1] > 0) {
          for (int around = 0; around < 9; ++around) {
            std::fill_n(near_.begin() + (z + around / 3) * layer + (y + around % 3) * row + x, 3, std::uint8_t{1});
          }
        }
        first_[k + 1] += first_[k];
      }
    }
  }
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::int32_t place = next[cell[i]]++;
    node_[place] = static_cast<std::int32_t>(i);
    x_[place] = nodes[i][0];
    y_[place] = nodes[i][1];
    z_[place] = nodes[i][2];
  }
}

bool GrainGrid::near(const Vector3& x) const {
  std::int64_t index = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const int c = coordinate(x[axis], axis) + 1;
    if (c < 0 || c > n_cells_[axis] + 1) {
      return false;
    }
    index = index * (n_cells_[axis] + 2) + c;
  }
  return near_[index] != 0;
}

} // namespace boba
