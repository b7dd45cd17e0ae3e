// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/parallel/placement.h"

#include "base/hilbert_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace boba {

namespace {

constexpr int levels = 10; // 2^10 cells a side

/// Grains that may share a block, each group in order of their numbers.
std::map<std::pair<int, bool>, std::vector<int>> groups_of(const Packing& packing) {
  std::map<std::pair<int, bool>, std::vector<int>> groups;
  for (int g = 0; g < packing.n_grains(); ++g) {
    groups[{packing.grains[g].template_index, packing.grains[g].alpha != 0.0}].push_back(g);
  }
  return groups;
}

/// Cuts a row of grains into a piece for each rank; `unit` grains stay together.
void cut(const std::vector<int>& row, std::size_t unit, const PlacementInput& input, std::vector<int>& owner) {
  double total = 0.0;
  for (const int g : row) {
    total += input.cost[g];
  }
  double before = 0.0;
  for (std::size_t begin = 0; begin < row.size(); begin += unit) {
    const std::size_t end = std::min(begin + unit, row.size());
    double here = 0.0;
    for (std::size_t k = begin; k < end; ++k) {
      here += input.cost[row[k]];
    }
    // The rank whose share the middle of this unit lies in.
    const double middle = total > 0.0 ? (before + 0.5 * here) / total : 0.0;
    const int rank = std::clamp(static_cast<int>(middle * input.n_ranks), 0, input.n_ranks - 1);
    for (std::size_t k = begin; k < end; ++k) {
      owner[row[k]] = rank;
    }
    before += here;
  }
}

std::vector<Vector3> fractional_centres(const Packing& packing) {
  std::vector<Vector3> centres;
  const std::vector<std::int64_t> first = packing.first_nodes();
  for (int g = 0; g < packing.n_grains(); ++g) {
    Vector3 sum = Vector3::Zero();
    for (std::int64_t node = first[g]; node < first[g + 1]; ++node) {
      sum += packing.position[node];
    }
    centres.push_back(packing.box.to_fractional(sum / static_cast<double>(first[g + 1] - first[g])));
  }
  return centres;
}

} // namespace

std::uint64_t place_along_curve(const Vector3& fractional) {
  std::array<std::uint32_t, 3> cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double inside = fractional[axis] - std::floor(fractional[axis]);
    cell[axis] = std::min(static_cast<std::uint32_t>(inside * (1 << levels)), (1U << levels) - 1);
  }
  return hilbert_index(cell, levels);
}

std::vector<int> along_curve(std::span<const int> grains, std::span<const Vector3> fractional) {
  std::vector<int> order(grains.begin(), grains.end());
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return place_along_curve(fractional[a]) < place_along_curve(fractional[b]); });
  return order;
}

std::vector<int> place_grains(const PlacementInput& input) {
  std::vector<int> owner(input.packing->n_grains(), 0);
  for (const auto& [key, members] : groups_of(*input.packing)) {
    const std::vector<int> row = along_curve(members, input.fractional);
    const auto lanes = static_cast<std::size_t>(input.block_lanes);
    const bool enough = row.size() / lanes >= static_cast<std::size_t>(input.n_ranks);
    cut(row, enough ? lanes : 1, input, owner);
  }
  return owner;
}

double imbalance(const PlacementInput& input, std::span<const int> owner) {
  std::vector<double> cost(input.n_ranks, 0.0);
  for (const auto& [key, members] : groups_of(*input.packing)) {
    std::vector<double> count(input.n_ranks, 0.0), sum(input.n_ranks, 0.0);
    for (const int g : members) {
      count[owner[g]] += 1.0;
      sum[owner[g]] += input.cost[g];
    }
    for (int r = 0; r < input.n_ranks; ++r) {
      if (count[r] > 0.0) {
        cost[r] += sum[r] / count[r] * input.block_lanes * std::ceil(count[r] / input.block_lanes);
      }
    }
  }
  const double mean = std::accumulate(cost.begin(), cost.end(), 0.0) / input.n_ranks;
  return mean > 0.0 ? *std::max_element(cost.begin(), cost.end()) / mean : 1.0;
}

Distribution distribute(const Packing& packing, const Ranks& ranks, Precision precision) {
  if (!ranks.is_distributed()) {
    return {};
  }
  const std::vector<int> n_nodes = packing.nodes_of_grains();
  const PlacementInput input = {
      &packing, ranks.size(), lanes_of_block(precision), fractional_centres(packing), {n_nodes.begin(), n_nodes.end()}};
  return {&ranks, Ownership(place_grains(input), ranks.size(), n_nodes)};
}

std::vector<int> own_grains(const Packing& packing, const Distribution& distribution) {
  if (!distribution.is_distributed()) {
    std::vector<int> all(packing.n_grains());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  return along_curve(distribution.ownership.grains_of(distribution.ranks->rank()), fractional_centres(packing));
}

} // namespace boba
