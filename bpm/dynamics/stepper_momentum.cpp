// SPDX-License-Identifier: GPL-3.0-or-later
// Momentum in mixed precision. The rounding errors of a packing's forces do not add up to zero, and at rest they are
// the same at every step: nothing damps the motion of the whole, so that it would be accelerated for good.
#include "bpm/dynamics/stepper.h"

namespace boba {

/// Over all ranks, grain by grain in the packing's order: the same whatever the lanes, threads and ranks.
Vector3 Stepper::velocity_sum() const {
  std::vector<Vector3> of_grain(layout_.n_grains(), Vector3::Zero());
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : layout_.grains()) {
    of_grain[g] = state_.velocity_sum(g);
  }
  share_grains(of_grain);
  Vector3 sum = Vector3::Zero();
  for (const Vector3& v : of_grain) {
    sum += v;
  }
  return sum;
}

void Stepper::note_momentum() {
  if (options_.precision == Precision::mixed) {
    velocity_sum_ = velocity_sum();
  }
}

/// Takes the change of the total momentum since it was noted from all nodes alike. Bonds and contacts cannot change it;
/// walls and clamps can, and then nothing is done.
void Stepper::restore_momentum() {
  if (options_.precision == Precision::full || !forces_.walls().empty() || !clamps_.empty()) {
    return;
  }
  const Vector3 change = (velocity_sum_ - velocity_sum()) / static_cast<double>(packing_.first_nodes().back());
#pragma omp parallel for schedule(dynamic, 1)
  for (const int g : layout_.grains()) {
    state_.add_velocity(g, change);
  }
}

} // namespace boba
