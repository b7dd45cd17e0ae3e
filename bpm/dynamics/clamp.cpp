// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/clamp.h"

namespace boba {

Clamp clamp_between(double low, double high, const LaneLayout& layout, const LaneState& state) {
  Clamp clamp;
  for (int g = 0; g < layout.n_grains(); ++g) {
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

void apply_clamp(Clamp& clamp, LaneState& state) {
  clamp.force.setZero();
  for (std::size_t k = 0; k < clamp.node.size(); ++k) {
    const int grain = static_cast<int>(clamp.grain[k]), node = static_cast<int>(clamp.node[k]);
    clamp.force += state.force(grain, node);
    state.set_force(grain, node, Vector3::Zero());
    state.set_velocity(grain, node, clamp.velocity);
  }
}

} // namespace boba
