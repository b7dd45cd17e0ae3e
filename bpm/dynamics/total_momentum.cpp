// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/total_momentum.h"

#include "bpm/dynamics/node_exchange.h"

namespace boba {

namespace {

/// Over all ranks, grain by grain in the packing's order: the same whatever the lanes, threads and ranks.
Vector3 peculiar_velocity_sum(const MovingPacking& moving, const Matrix3& streaming) {
  std::vector<Vector3> of_grain(moving.layout.n_grains(), Vector3::Zero());
  const bool streams = streaming != Matrix3::Zero();
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : moving.layout.grains()) {
    of_grain[g] = moving.state.velocity_sum(g);
    if (streams) {
      const Vector3 from_origin = moving.state.position_sum(g) - moving.layout.n_nodes(g) * moving.cell.box().origin();
      of_grain[g] -= streaming * from_origin;
    }
  }
  share_grains(moving, of_grain);
  Vector3 sum = Vector3::Zero();
  for (const Vector3& v : of_grain) {
    sum += v;
  }
  return sum;
}

void add_to_momentum(MovingPacking& moving, const Vector3& difference) {
  const Vector3 change = difference / moving.n_nodes();
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : moving.layout.grains()) {
    moving.state.add_velocity(g, change);
  }
}

/// Bonds and contacts cannot change the momentum; walls, clamps and gravity can.
bool is_conserved(const MovingPacking& moving) {
  return moving.ends.are_free() && moving.material.gravity == std::array<double, 3>{};
}

} // namespace

void note_momentum(MovingPacking& moving, const Matrix3& streaming) {
  moving.noted_momentum = peculiar_velocity_sum(moving, streaming);
}

void note_motion_along_gradient(MovingPacking& moving) {
  moving.momentum_along_gradient += moving.options.dt * (moving.cell.streaming() * moving.noted_momentum);
}

void restore_momentum(MovingPacking& moving) {
  if (is_conserved(moving)) {
    const Vector3 expected = moving.noted_momentum - moving.momentum_along_gradient;
    add_to_momentum(moving, expected - peculiar_velocity_sum(moving, moving.cell.streaming()));
  }
}

void restore_momentum_without_streaming(MovingPacking& moving) {
  moving.momentum_along_gradient.setZero();
  if (is_conserved(moving)) {
    add_to_momentum(moving, moving.noted_momentum - peculiar_velocity_sum(moving, Matrix3::Zero()));
  }
}

} // namespace boba
