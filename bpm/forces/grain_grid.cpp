// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/grain_grid.h"

#include <Eigen/Core>

namespace boba {

GrainGrid::GrainGrid(std::span<const Vector3> nodes, const Bounds& bounds, double reach)
    : bounds_(bounds), reach_(reach), inverse_cell_(1.0 / reach), node_(nodes.size()), x_(nodes.size()),
      y_(nodes.size()), z_(nodes.size()) {
  std::int64_t n = 1, n_ringed = 1;
  for (int axis = 0; axis < 3; ++axis) {
    n_cells_[axis] = 1 + static_cast<int>((bounds.high[axis] - bounds.low[axis]) * inverse_cell_);
    n *= n_cells_[axis];
    n_ringed *= n_cells_[axis] + 2 * ring;
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
  std::int64_t k = 0;
  for (int z = 0; z < n_cells_[2]; ++z) {
    for (int y = 0; y < n_cells_[1]; ++y) {
      for (int x = 0; x < n_cells_[0]; ++x, ++k) {
        if (first_[k + 1] > 0) {
          mark_around(x, y, z);
        }
        first_[k + 1] += first_[k];
      }
    }
  }
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::int32_t place = next[cell[i]]++;
    node_[place] = static_cast<std::int32_t>(i);
    x_[place] = static_cast<float>(nodes[i][0]);
    y_[place] = static_cast<float>(nodes[i][1]);
    z_[place] = static_cast<float>(nodes[i][2]);
  }
}

void GrainGrid::mark_around(int x, int y, int z) {
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      std::fill_n(near_.begin() + ringed(x - 1, y + dy, z + dz), 3, std::uint8_t{1});
    }
  }
}

void GrainGrid::insert(std::int32_t node, const Vector3& position) {
  if (last_inserted_.empty()) {
    last_inserted_.assign(near_.size(), -1);
  }
  int c[3];
  for (int axis = 0; axis < 3; ++axis) {
    c[axis] = std::clamp(coordinate(position[axis], axis), -1, n_cells_[axis]);
  }
  std::int32_t& last = last_inserted_[ringed(c[0], c[1], c[2])];
  inserted_.push_back({position, node, last});
  last = static_cast<std::int32_t>(inserted_.size()) - 1;
  mark_around(c[0], c[1], c[2]);
}

float GrainGrid::extent(const Vector3& direction) const {
  const Eigen::Vector3f d = direction.cast<float>();
  const auto n = static_cast<Eigen::Index>(x_.size());
  const auto column = [n](const std::vector<float>& values) {
    return Eigen::Map<const Eigen::ArrayXf>(values.data(), n);
  };
  float largest = (d[0] * column(x_) + d[1] * column(y_) + d[2] * column(z_)).maxCoeff();
  for (const Inserted& inserted : inserted_) {
    largest = std::max(largest, d.dot(inserted.position.cast<float>()));
  }
  return largest;
}

bool GrainGrid::near(const Vector3& x) const {
  int c[3];
  for (int axis = 0; axis < 3; ++axis) {
    c[axis] = coordinate(x[axis], axis);
    if (c[axis] < -ring || c[axis] >= n_cells_[axis] + ring) {
      return false;
    }
  }
  return near_[ringed(c[0], c[1], c[2])] != 0;
}

} // namespace boba
