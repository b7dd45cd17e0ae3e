// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/blow_up.h"

#include <fmt/format.h>

#include <cmath>

namespace boba {

namespace {

std::string likely_cause(double dt) {
  if (dt > 0.2) {
    return fmt::format("dt = {} tau is above the usual stability limit; try run.dt = 0.1", dt);
  }
  return "grains overlap too deeply (insertion too dense, a wall or the cell moving too fast), alpha is near its lower "
         "limit, or dt is too large for this alpha; try a smaller run.dt or a smaller rate";
}

} // namespace

std::string describe_fast_node(const Block& block, const LaneState& state, std::int64_t step, double dt,
                               const Material& material) {
  int worst_grain = -1, worst_node = 0;
  double worst = -1.0;
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    for (int node = 0; node < block.n_nodes; ++node) {
      double v2 = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double v = state.v[block.offset + (3 * static_cast<std::int64_t>(node) + c) * block.n_lanes + lane];
        v2 += v * v;
      }
      if (!(v2 <= worst) || !std::isfinite(v2)) {
        worst = v2;
        worst_grain = block.grain[lane];
        worst_node = node;
        if (!std::isfinite(v2)) {
          break;
        }
      }
    }
    if (!std::isfinite(worst)) {
      break;
    }
  }
  const std::string what = std::isfinite(worst)
                               ? fmt::format("moves {:.3g} d in one step, more than the {} d allowed", dt * std::sqrt(worst),
                                             0.5 * material.diameter)
                               : std::string("has a velocity that is not a finite number");
  return fmt::format("blow-up at step {}: node {} of grain {} {}. Likely cause: {}.", step, worst_node, worst_grain, what,
                     likely_cause(dt));
}

std::string describe_stretched_bond(const ForceField::Stretch& stretch, std::int64_t step, double dt) {
  return fmt::format("blow-up at step {}: a bond of node {} of grain {} is stretched to {:.3g} times its length, more than "
                     "the {} allowed. Likely cause: {}.",
                     step, stretch.node, stretch.grain, stretch.ratio, largest_bond_stretch, likely_cause(dt));
}

} // namespace boba
