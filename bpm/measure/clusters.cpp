// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/clusters.h"

#include <Eigen/LU>
#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace boba::measure {

namespace {

using CellOffset = Eigen::Vector3i;

/// Union-find over grains in a periodic cell.
class PeriodicForest {
public:
  explicit PeriodicForest(std::size_t n) : parent_(n), size_(n, 1), offset_(n, CellOffset::Zero()), windings_(n) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// The copy of `second` that is displaced by `image` cells hangs together with `first`.
  void join(int first, int second, const CellOffset& image) {
    int root = find(first), other = find(second);
    // From the root's copy to the copy of `other` that the bond reaches.
    CellOffset between = offset_[first] + image - offset_[second];
    if (root == other) {
      if (between != CellOffset::Zero()) {
        windings_[root].push_back(between);
      }
      return;
    }
    if (size_[root] < size_[other]) {
      std::swap(root, other);
      between = -between;
    }
    parent_[other] = root;
    size_[root] += size_[other];
    offset_[other] = between;
    windings_[root].insert(windings_[root].end(), windings_[other].begin(), windings_[other].end());
    windings_[other].clear();
  }

  /// The root of a grain; afterwards its offset is the one from that root.
  int find(int grain) {
    if (parent_[grain] == grain) {
      return grain;
    }
    const int parent = parent_[grain];
    const int root = find(parent);
    if (parent != root) {
      offset_[grain] += offset_[parent];
      parent_[grain] = root;
    }
    return root;
  }

  const std::vector<CellOffset>& windings(int root) const { return windings_[root]; }

private:
  std::vector<int> parent_;
  std::vector<int> size_;          ///< of a root's tree
  std::vector<CellOffset> offset_; ///< cells from the parent's copy to the grain's own
  std::vector<std::vector<CellOffset>> windings_;
};

int rank_of_windings(const std::vector<CellOffset>& windings) {
  if (windings.empty()) {
    return 0;
  }
  Eigen::MatrixXd rows(windings.size(), 3);
  for (std::size_t i = 0; i < windings.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = windings[i].cast<double>().transpose();
  }
  return static_cast<int>(Eigen::FullPivLU<Eigen::MatrixXd>(rows).rank());
}

} // namespace

std::vector<Cluster> clusters(const Box& box, std::span<const Vector3> centres, const std::vector<bool>& member,
                              std::span<const GrainBond> bonds) {
  Box reduced = box;
  reduced.flip();
  const auto n = static_cast<int>(centres.size());
  PeriodicForest forest(centres.size());
  for (const GrainBond& bond : bonds) {
    if (bond.first < 0 || bond.first >= n || bond.second < 0 || bond.second >= n) {
      throw std::invalid_argument(
          fmt::format("clusters: a bond names the grains {} and {} of {}", bond.first, bond.second, n));
    }
    if (!member[bond.first] || !member[bond.second]) {
      continue;
    }
    const Vector3 cells = reduced.h_inverse() * (bond.vector - (centres[bond.second] - centres[bond.first]));
    forest.join(bond.first, bond.second, cells.array().round().matrix().cast<int>());
  }
  std::vector<Cluster> found;
  std::vector<int> cluster_of(centres.size(), -1); // by root
  for (int grain = 0; grain < n; ++grain) {
    if (!member[grain]) {
      continue;
    }
    const int root = forest.find(grain);
    if (cluster_of[root] < 0) {
      cluster_of[root] = static_cast<int>(found.size());
      Cluster cluster;
      for (const CellOffset& winding : forest.windings(root)) {
        for (int axis = 0; axis < 3; ++axis) {
          cluster.percolates[axis] = cluster.percolates[axis] || winding[axis] != 0;
        }
      }
      cluster.dimension = rank_of_windings(forest.windings(root));
      found.push_back(std::move(cluster));
    }
    found[cluster_of[root]].grains.push_back(grain);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Cluster& a, const Cluster& b) { return a.grains.size() > b.grains.size(); });
  return found;
}

std::vector<Cluster> solid_clusters(const Box& box, std::span<const Vector3> centres, const NeighbourLists& neighbours,
                                    const std::vector<BondOrder>& orders, const BondOrderOptions& options) {
  std::vector<bool> member(orders.size());
  std::vector<GrainBond> bonds;
  for (std::size_t grain = 0; grain < orders.size(); ++grain) {
    member[grain] = orders[grain].n_solid_bonds >= options.min_solid_bonds;
    for (std::size_t k = 0; k < neighbours[grain].size(); ++k) {
      if (orders[grain].solid[k]) {
        bonds.push_back({static_cast<int>(grain), neighbours[grain][k].grain, neighbours[grain][k].vector});
      }
    }
  }
  return clusters(box, centres, member, bonds);
}

int largest_finite(const std::vector<Cluster>& clusters) {
  // Largest first.
  const auto finite = std::find_if(clusters.begin(), clusters.end(), [](const Cluster& c) { return !c.spans(); });
  return finite == clusters.end() ? 0 : static_cast<int>(finite->grains.size());
}

} // namespace boba::measure
