// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/blow_up.h"

#include <cmath>
#include <fmt/format.h>

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
  for (const int grain : block.grain) {
    for (int node = 0; grain >= 0 && node < block.n_nodes && std::isfinite(worst); ++node) {
      const double v2 = state.velocity(grain, node).squaredNorm();
      if (!(v2 <= worst)) { // also true for NaN
        worst = v2;
        worst_grain = grain;
        worst_node = node;
      }
    }
  }
  const std::string what = std::isfinite(worst) ? fmt::format("moves {:.3g} d in one step, more than the {} d allowed",
                                                              dt * std::sqrt(worst), 0.5 * material.diameter)
                                                : std::string("has a velocity that is not a finite number");
  return fmt::format("blow-up at step {}: node {} of grain {} {}. Likely cause: {}.", step, worst_node, worst_grain,
                     what, likely_cause(dt));
}

std::string describe_torn_grain(double share, std::int64_t step, double dt) {
  return fmt::format(
      "blow-up at step {}: a grain reaches {:.0f} % of the range of fixed-point positions, four times the "
      "largest grain's radius. Likely cause: {}.",
      step, 100.0 * share, likely_cause(dt));
}

std::string describe_alternation(const Block& block, std::int64_t step, double dt, double moved) {
  int grain = -1;
  for (const int other : block.grain) {
    grain = grain < 0 ? other : grain;
  }
  return fmt::format(
      "blow-up at step {}: the nodes of grain {} or one of the {} grains stored with it turn round at every step "
      "({:.3g} d each): dt = {:g} tau is too large for these grains and their contacts; try a smaller run.dt, or "
      "run.dt = \"auto\"",
      step, grain, block.n_grains(), moved, dt);
}

std::string describe_stretched_bond(const Stretch& stretch, std::int64_t step, double dt) {
  return fmt::format(
      "blow-up at step {}: a bond of node {} of grain {} is stretched to {:.3g} times its length, more than "
      "the {} allowed. Likely cause: {}.",
      step, stretch.node, stretch.grain, stretch.ratio, largest_bond_stretch, likely_cause(dt));
}

} // namespace boba
