// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/clamp.h"

namespace boba {

Clamp clamp_between(double low, double high, const LaneLayout& layout, const LaneState& state) {
  Clamp clamp;
  for (int g = 0; g < layout.n_grains(); ++g) {
    for (int node = 0; node < layout.n_nodes(g); ++node) {
      const double z = state.x[layout.index(g, node, 2)];
      if (z >= low && z <= high) {
        clamp.first.push_back(layout.index(g, node, 0));
        clamp.stride.push_back(layout.stride(g));
      }
    }
  }
  return clamp;
}

void apply_clamp(Clamp& clamp, LaneState& state) {
  clamp.force.setZero();
  for (std::size_t k = 0; k < clamp.first.size(); ++k) {
    for (int c = 0; c < 3; ++c) {
      const std::int64_t at = clamp.first[k] + static_cast<std::int64_t>(c) * clamp.stride[k];
      clamp.force[c] += state.f[at];
      state.f[at] = 0.0;
      state.v[at] = clamp.velocity[c];
    }
  }
}

} // namespace boba
