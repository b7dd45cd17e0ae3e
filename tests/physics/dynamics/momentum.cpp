// SPDX-License-Identifier: GPL-3.0-or-later
// The momentum of a packing in mixed precision: what bonds and contacts cannot change stays, what walls change does not.
#include "bpm/dynamics/stepper.h"
#include "tests/support/small_packings.h"

#include <gtest/gtest.h>

namespace boba::test {
namespace {

Vector3 mean_velocity(const Stepper& stepper) {
  const Snapshot snapshot = stepper.snapshot({.velocity = true});
  Vector3 sum = Vector3::Zero();
  for (const Vector3& v : snapshot.velocity) {
    sum += v;
  }
  return sum / static_cast<double>(snapshot.velocity.size());
}

Packing dense_grains() {
  return small_packing({.box = Box(Vector3::Zero(), {12.0, 11.0, 12.0}, {5.0, -4.0, 3.0}), .n_grains = 9, .speed = 0.01});
}

// Without a cure the rounding errors of the forces change the mean velocity by 1.5e-9 d/tau in that time; floats of these
// velocities are 1e-10 d/tau apart.
TEST(Momentum, OfAPackingInMixedPrecisionStays) {
  Packing packing = dense_grains();
  for (Vector3& v : packing.velocity) {
    v += Vector3(3e-4, -2e-4, 1e-4);
  }
  Vector3 before = Vector3::Zero();
  for (const Vector3& v : packing.velocity) {
    before += v / static_cast<double>(packing.velocity.size());
  }
  Stepper stepper(std::move(packing), {}, {.precision = Precision::mixed});
  stepper.start();
  const int n_steps = 64 * 300;
  for (int step = 1; step <= n_steps; ++step) {
    stepper.advance(step < n_steps ? Virial::none : Virial::full);
  }
  EXPECT_LT((mean_velocity(stepper) - before).norm(), 3e-10);
}

TEST(Momentum, IsTakenByWalls) {
  Packing packing = dense_grains();
  packing.box = Box(Vector3::Zero(), {200.0, 200.0, 200.0}, Vector3::Zero(), {false, false, false});
  Stepper stepper(std::move(packing), {}, {.precision = Precision::mixed});
  const double low = stepper.extent_z()[0];
  stepper.forces().walls() = {{low * Vector3::UnitZ(), Vector3::UnitZ(), Vector3::Zero()}};
  stepper.start();
  for (int step = 1; step <= 320; ++step) {
    stepper.advance(step < 320 ? Virial::none : Virial::full);
  }
  EXPECT_GT(mean_velocity(stepper)[2], 1e-4);
}

} // namespace
} // namespace boba::test
