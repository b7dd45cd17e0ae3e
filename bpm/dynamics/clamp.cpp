// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/clamp.h"

#include <algorithm>

namespace boba {

Clamp clamp_between(double low, double high, const LaneLayout& layout, const LaneState& state) {
  Clamp clamp;
  for (const int g : layout.grains()) {
    for (int node = 0; node < layout.n_nodes(g); ++node) {
      const double z = state.position(g, node)[2];
      if (z >= low && z <= high) {
        clamp.grain.push_back(g);
        clamp.node.push_back(node);
      }
    }
  }
  return clamp;
}

void apply_clamp(Clamp& clamp, const LaneLayout& layout, LaneState& state, const Distribution& distribution) {
  std::vector<Vector3> of_grain(layout.n_grains(), Vector3::Zero());
  for (std::size_t k = 0; k < clamp.node.size(); ++k) {
    const int grain = static_cast<int>(clamp.grain[k]), node = static_cast<int>(clamp.node[k]);
    if (layout.holds(grain)) {
      of_grain[grain] += state.force(grain, node);
      state.set_force(grain, node, Vector3::Zero());
      state.set_velocity(grain, node, clamp.velocity);
    }
  }
  distribution.ranks->share_rows({of_grain.data()->data(), 3 * of_grain.size()}, 3, distribution.ownership);
  clamp.force.setZero();
  for (const Vector3& force : of_grain) { // grain by grain: the same sum for any number of ranks
    clamp.force += force;
  }
}

void share_clamp(Clamp& clamp, const Distribution& distribution, int n_grains) {
  if (!distribution.is_distributed()) {
    return;
  }
  // A row a grain with its number of clamped nodes, then rows wide enough for the largest of these.
  std::vector<double> count(n_grains, 0.0);
  for (const std::int64_t grain : clamp.grain) {
    count[grain] += 1.0;
  }
  distribution.ranks->share_rows(count, 1, distribution.ownership);
  const int width = static_cast<int>(*std::max_element(count.begin(), count.end()));
  std::vector<double> nodes(static_cast<std::size_t>(n_grains) * width, 0.0);
  std::vector<int> filled(n_grains, 0);
  for (std::size_t k = 0; k < clamp.node.size(); ++k) {
    nodes[clamp.grain[k] * width + filled[clamp.grain[k]]++] = static_cast<double>(clamp.node[k]);
  }
  distribution.ranks->share_rows(nodes, width, distribution.ownership);
  clamp.grain.clear();
  clamp.node.clear();
  for (int g = 0; g < n_grains; ++g) {
    for (int k = 0; k < static_cast<int>(count[g]); ++k) {
      clamp.grain.push_back(g);
      clamp.node.push_back(static_cast<std::int64_t>(nodes[static_cast<std::size_t>(g) * width + k]));
    }
  }
}

} // namespace boba
