// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/near_pairs.h"

#include "base/bounds.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Nodes binned into cells at least one cut-off wide.
class CellGrid {
public:
  CellGrid(const std::vector<Vector3d>& position, double cutoff, const std::optional<Vector3d>& period)
      : periodic_(period.has_value()) {
    Vector3d length;
    if (period) {
      origin_ = -0.5 * *period;
      length = *period;
    } else {
      const Bounds bounds = bounds_of(position);
      origin_ = bounds.low;
      length = bounds.extent().cwiseMax(cutoff);
    }
    for (int a = 0; a < 3; ++a) {
      count_[a] = std::clamp(static_cast<int>(length[a] / cutoff), 1, 1000);
    }
    width_ = length.cwiseQuotient(count_.cast<double>());
    fill(position);
  }

  /// Calls use(j) for every node in the cells around x, each cell once.
  template <class Use> void for_each_near(const Vector3d& x, Use&& use) const {
    const Vector3i centre = cell_of(x);
    for (int dz = low(2); dz <= high(2); ++dz) {
      for (int dy = low(1); dy <= high(1); ++dy) {
        for (int dx = low(0); dx <= high(0); ++dx) {
          Vector3i c = centre + Vector3i(dx, dy, dz);
          if (periodic_) {
            c = c.binaryExpr(count_, [](int value, int n) { return (value + n) % n; });
          } else if (c.minCoeff() < 0 || (c - count_).maxCoeff() >= 0) {
            continue;
          }
          for (int k = first_[index(c)]; k < first_[index(c) + 1]; ++k) {
            use(node_[k]);
          }
        }
      }
    }
  }

private:
  // A periodic direction with one or two cells would name the same cell twice.
  int low(int a) const { return periodic_ && count_[a] == 1 ? 0 : -1; }
  int high(int a) const { return periodic_ && count_[a] <= 2 ? 0 : 1; }

  int index(const Vector3i& c) const { return c.x() + count_.x() * (c.y() + count_.y() * c.z()); }
  Vector3i cell_of(const Vector3d& x) const {
    Vector3i c;
    for (int a = 0; a < 3; ++a) {
      c[a] = std::clamp(static_cast<int>((x[a] - origin_[a]) / width_[a]), 0, count_[a] - 1);
    }
    return c;
  }

  void fill(const std::vector<Vector3d>& position) {
    std::vector<int> cell(position.size());
    first_.assign(count_.prod() + 1, 0);
    for (std::size_t n = 0; n < position.size(); ++n) {
      cell[n] = index(cell_of(position[n]));
      ++first_[cell[n] + 1];
    }
    for (std::size_t c = 1; c < first_.size(); ++c) {
      first_[c] += first_[c - 1];
    }
    node_.resize(position.size());
    std::vector<int> next(first_.begin(), first_.end() - 1);
    for (std::size_t n = 0; n < position.size(); ++n) {
      node_[next[cell[n]]++] = static_cast<int>(n);
    }
  }

  bool periodic_;
  Vector3d origin_;
  Vector3d width_;
  Vector3i count_;
  std::vector<int> first_; // per cell, index into node_; size n_cells + 1
  std::vector<int> node_;
};

} // namespace

std::array<Vector3d, 27> image_shifts(const Vector3d& period) {
  std::array<Vector3d, 27> shifts;
  for (int s = 0; s < 27; ++s) {
    shifts[s] = period.cwiseProduct(Vector3i(s % 3 - 1, s / 3 % 3 - 1, s / 9 - 1).cast<double>());
  }
  return shifts;
}

Vector3d wrapped(const Vector3d& x, const Vector3d& period) {
  const Eigen::Array3d n = (x.cwiseQuotient(period).array() + 0.5).floor();
  return x - period.cwiseProduct(n.matrix());
}

std::vector<NearPair> near_pairs(const std::vector<Vector3d>& position, double cutoff,
                                 const std::optional<Vector3d>& period) {
  if (position.empty()) {
    return {};
  }
  if (period && period->minCoeff() < 2.0 * cutoff) {
    throw std::invalid_argument(fmt::format("periodic box: its shortest length {} is below twice the pair distance {}",
                                            period->minCoeff(), cutoff));
  }
  const CellGrid grid(position, cutoff, period);
  const Vector3d lengths = period.value_or(Vector3d::Constant(1.0));
  std::vector<NearPair> pairs, of_node;
  for (int i = 0; i < static_cast<int>(position.size()); ++i) {
    of_node.clear();
    grid.for_each_near(position[i], [&](int j) {
      if (j <= i) {
        return;
      }
      Vector3d r = position[i] - position[j];
      Eigen::Array3d n = Eigen::Array3d::Zero();
      if (period) {
        n = r.cwiseQuotient(lengths).array().round();
        r -= lengths.cwiseProduct(n.matrix());
      }
      if (r.squaredNorm() < cutoff * cutoff) {
        of_node.push_back({i, j, static_cast<std::int8_t>(n.x() + 1.0 + 3.0 * (n.y() + 1.0) + 9.0 * (n.z() + 1.0))});
      }
    });
    std::sort(of_node.begin(), of_node.end(), [](const NearPair& a, const NearPair& b) { return a.j < b.j; });
    pairs.insert(pairs.end(), of_node.begin(), of_node.end());
  }
  return pairs;
}

} // namespace boba
