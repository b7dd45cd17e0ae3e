// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/blow_up_checks.h"

#include "bpm/dynamics/blow_up.h"

#include <cmath>

namespace boba {

namespace {

/// Largest coordinate of a node, as a share of the range of fixed-point positions.
constexpr double largest_range_share = 0.45;
/// Kinetic energy of full steps over that of half steps below which velocities change sign from step to step.
constexpr double least_smoothness = 0.25;
/// d a step, root mean square over a block. Below it a few nodes at most may do that, at the ends of a bond that
/// collapsed.
constexpr double least_motion = 3e-3;

} // namespace

double largest_allowed_speed(const MovingPacking& moving) {
  return 0.5 * moving.material.diameter / moving.options.dt;
}

namespace {

/// Are the nodes of the block's grains within the limit? Otherwise it is an idle lane that is beyond it.
bool grains_are_within(const MovingPacking& moving, const Block& block, double limit) {
  const Matrix3& streaming = moving.cell.streaming();
  const Vector3 origin = moving.cell.box().origin();
  for (const int grain : block.grain) {
    for (int node = 0; grain >= 0 && node < block.n_nodes; ++node) {
      const Vector3 own =
          moving.state.velocity(grain, node) - streaming * (moving.state.position(grain, node) - origin);
      if (!(own.squaredNorm() <= limit * limit)) { // also true for NaN
        return false;
      }
    }
  }
  return true;
}

} // namespace

void check_drift(MovingPacking& moving, const std::vector<BlockMotion>& motion) {
  const double limit = largest_allowed_speed(moving);
  for (std::size_t b = 0; b < motion.size(); ++b) {
    if (!std::isfinite(motion[b].checksum) || motion[b].largest_speed2 > limit * limit) {
      const Block& block = moving.layout.blocks()[b];
      if (grains_are_within(moving, block, limit)) {
        moving.state.reset_idle_lanes(block, *moving.packing.templates[block.template_index]);
        continue;
      }
      throw BlowUp(describe_fast_node(moving.layout.blocks()[b], moving.state, moving.step + 1, moving.options.dt,
                                      moving.material));
    }
  }
}

void recentre_grains(MovingPacking& moving) {
  const double share = moving.ranks().largest(moving.state.recentre());
  if (share > largest_range_share) {
    throw BlowUp(describe_torn_grain(share, moving.step + 1, moving.options.dt));
  }
}

void check_alternation(const MovingPacking& moving) {
  if (moving.ends.has_clamps() || moving.cell.residual_rate() != Matrix3::Zero()) {
    return; // part of the velocities is then not the nodes' own
  }
  const double dt = moving.options.dt;
  for (const Block& block : moving.layout.blocks()) {
    double full_step = 0.0, speed2 = 0.0; // idle lanes have no part in it
    for (const int grain : block.grain) {
      full_step += grain >= 0 ? moving.forces.grain_sums()[grain].kinetic_trace : 0.0;
      for (int node = 0; grain >= 0 && node < block.n_nodes; ++node) {
        speed2 += moving.state.velocity(grain, node).squaredNorm(); // of the half step to come
      }
    }
    const double half_step = speed2 * moving.material.node_mass;
    const double moved2 = dt * dt * speed2 / (block.n_grains() * block.n_nodes);
    if (full_step < least_smoothness * half_step && moved2 > least_motion * least_motion) {
      throw BlowUp(describe_alternation(block, moving.step, dt, std::sqrt(moved2)));
    }
  }
}

Stretch largest_stretch(const MovingPacking& moving) {
  const Ranks& ranks = moving.ranks();
  Stretch largest;
  if (!moving.layout.grains().empty()) {
    largest = moving.forces.survey(moving.state).largest_stretch(moving.cell.box());
  }
  const double not_a_number = std::isnan(largest.ratio) ? 1.0 : 0.0;
  double values[2] = {not_a_number, not_a_number > 0.0 ? 0.0 : largest.ratio};
  ranks.largest(values);
  const bool is_largest = values[0] > 0.0 ? not_a_number > 0.0 : largest.ratio == values[1];
  const double grain = ranks.smallest(is_largest ? largest.grain : moving.layout.n_grains());
  const double node = ranks.smallest(is_largest && largest.grain == grain ? largest.node : 1e15);
  return {values[0] > 0.0 ? std::nan("") : values[1], static_cast<int>(grain), static_cast<int>(node)};
}

void check_bonds(const MovingPacking& moving) {
  const Stretch stretch = largest_stretch(moving);
  if (!(stretch.ratio <= largest_bond_stretch)) {
    throw BlowUp(describe_stretched_bond(stretch, moving.step, moving.options.dt));
  }
}

} // namespace boba
