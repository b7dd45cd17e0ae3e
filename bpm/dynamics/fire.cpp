// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/fire.h"

#include "bpm/dynamics/node_exchange.h"
#include "bpm/dynamics/scoped_threads.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

constexpr double first_mixing = 0.25, shrink = 0.99;
constexpr int delay = 5;

struct Sums {
  double power = 0.0;         ///< f . v before the last kick
  double speed2 = 0.0;        ///< v . v
  double force2 = 0.0;        ///< f . f
  double largest_force = 0.0; ///< k d
};

/// Grain by grain in the packing's order, so that the sums are the same for any threads and ranks.
Sums sums_of(const MovingPacking& moving) {
  const double kick = moving.options.dt / moving.material.node_mass;
  std::vector<Vector3> of_grain(moving.layout.n_grains(), Vector3::Zero()), largest = of_grain;
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : moving.layout.grains()) {
    for (int node = 0; node < moving.layout.n_nodes(g); ++node) {
      const Vector3 f = moving.state.force(g, node), v = moving.state.velocity(g, node);
      of_grain[g] += Vector3(f.dot(v - kick * f), v.squaredNorm(), f.squaredNorm());
      largest[g][0] = std::max(largest[g][0], f.squaredNorm());
    }
  }
  share_grains(moving, of_grain);
  share_grains(moving, largest);
  Sums sums;
  for (std::size_t g = 0; g < of_grain.size(); ++g) {
    sums.power += of_grain[g][0];
    sums.speed2 += of_grain[g][1];
    sums.force2 += of_grain[g][2];
    sums.largest_force = std::max(sums.largest_force, std::sqrt(largest[g][0]));
  }
  return sums;
}

/// v <- along_v v + along_f f of all nodes.
void combine(MovingPacking& moving, double along_v, double along_f) {
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : moving.layout.grains()) {
    for (int node = 0; node < moving.layout.n_nodes(g); ++node) {
      moving.state.set_velocity(g, node,
                                along_v * moving.state.velocity(g, node) + along_f * moving.state.force(g, node));
    }
  }
}

} // namespace

double Fire::steer(MovingPacking& moving) {
  const ScopedThreads threads(moving.options.threads);
  const Sums sums = sums_of(moving);
  if (sums.power >= 0.0) { // 0 from rest: the last kick alone sets the nodes in motion
    combine(moving, 1.0 - mixing_, sums.force2 > 0.0 ? mixing_ * std::sqrt(sums.speed2 / sums.force2) : 0.0);
    if (++n_downhill_ > delay) {
      mixing_ *= shrink;
    }
  } else {
    stop(moving);
  }
  return sums.largest_force;
}

void Fire::stop(MovingPacking& moving) {
  const ScopedThreads threads(moving.options.threads);
  combine(moving, 0.0, 0.0);
  moving.noted_momentum.setZero();
  moving.momentum_along_gradient.setZero();
  mixing_ = first_mixing;
  n_downhill_ = 0;
}

void Fire::archive(Archive& archive) {
  archive.field("mixing", mixing_);
  archive.field("n_downhill", n_downhill_);
}

double largest_net_force(const MovingPacking& moving) {
  return sums_of(moving).largest_force;
}

} // namespace boba
