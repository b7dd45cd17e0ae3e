// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace boba {

/// Nodes that lie one after the other both in a file and where they come from.
struct NodeRun {
  std::int64_t first = 0; ///< in the packing's order
  std::int64_t n = 0;
};

/// The nodes of these grains as few runs; `first_node` as in Topology.
inline std::vector<NodeRun> node_runs(std::span<const int> grains, std::span<const std::int64_t> first_node) {
  std::vector<NodeRun> runs;
  for (const int g : grains) {
    const std::int64_t first = first_node[g], n = first_node[g + 1] - first;
    if (!runs.empty() && runs.back().first + runs.back().n == first) {
      runs.back().n += n;
    } else {
      runs.push_back({first, n});
    }
  }
  return runs;
}

} // namespace boba
