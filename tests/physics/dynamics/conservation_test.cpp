// SPDX-License-Identifier: GPL-3.0-or-later
// What bonds and contacts cannot change stays: momentum (in both precisions, but for walls), angular momentum, energy.
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "tests/physics/dynamics/nine_grains.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace boba::test {
namespace {

Vector3 sum(const std::vector<Vector3>& values) {
  return std::accumulate(values.begin(), values.end(), Vector3(0, 0, 0));
}

Vector3 mean(const std::vector<Vector3>& values) {
  return sum(values) / static_cast<double>(values.size());
}

Vector3 mean_velocity(const Stepper& stepper) {
  return mean(take_snapshot(stepper.moving(), {.velocity = true}).velocity);
}

Packing dense_grains() {
  return small_packing(
      {.box = Box(Vector3::Zero(), {12.0, 11.0, 12.0}, {5.0, -4.0, 3.0}), .n_grains = 9, .speed = 0.01});
}

// Without a cure the rounding errors of the forces change the mean velocity by 1.5e-9 d/tau in that time; floats of
// these velocities are 1e-10 d/tau apart.
TEST(Conservation, MomentumOfAPackingInMixedPrecisionStays) {
  Packing packing = dense_grains();
  for (Vector3& v : packing.velocity) {
    v += Vector3(3e-4, -2e-4, 1e-4);
  }
  const Vector3 before = mean(packing.velocity);
  Stepper stepper(std::move(packing), {}, {.precision = Precision::mixed});
  stepper.start();
  const int n_steps = 64 * 300;
  for (int step = 1; step <= n_steps; ++step) {
    stepper.advance(step < n_steps ? Virial::none : Virial::full);
  }
  EXPECT_LT((mean_velocity(stepper) - before).norm(), 3e-10);
}

// A drift of a thousandth of a quantum a step is not lost to rounding.
TEST(Conservation, MomentumOfASlowDriftInMixedPrecision) {
  const Packing still = small_packing(
      {.box = Box({0, 0, 0}, {40, 40, 40}), .n_grains = 3, .jitter = 0.0, .speed = 0.0, .least_distance = 8.0});
  Packing packing = still;
  const Vector3 velocity(1e-9, -3e-10, 2e-9);
  for (Vector3& v : packing.velocity) {
    v = velocity;
  }
  Stepper stepper(packing, {}, {.precision = Precision::mixed});
  stepper.start();
  const int n_steps = 20000;
  for (int step = 0; step < n_steps; ++step) {
    stepper.advance(step + 1 < n_steps ? Virial::none : Virial::full);
  }
  // What is left is a random walk: a node's rounding has at most half a quantum as standard deviation each step.
  const Snapshot end = take_snapshot(stepper.moving(), {.velocity = true});
  const std::vector<Vector3>& centres = end.grain_centre;
  const std::vector<std::int64_t> first = packing.first_nodes();
  const double quantum = std::ldexp(1.0, -27); // of a grain of radius up to 4 d
  for (int g = 0; g < packing.n_grains(); ++g) {
    Vector3 before = Vector3::Zero();
    for (std::int64_t node = first[g]; node < first[g + 1]; ++node) {
      before += packing.position[node] / static_cast<double>(first[g + 1] - first[g]);
    }
    const double walk = 0.5 * quantum * std::sqrt(3.0 * n_steps / static_cast<double>(first[g + 1] - first[g]));
    EXPECT_LT((centres[g] - before - velocity * stepper.time()).norm(), 3.0 * walk);
    EXPECT_GT((velocity * stepper.time()).norm(), 10.0 * walk);
  }
  double noise = 0.0;
  for (const Vector3& v : end.velocity) {
    noise += (v - velocity).squaredNorm() / static_cast<double>(end.velocity.size());
  }
  EXPECT_LT(std::sqrt(noise), 3.0 * quantum / stepper.options().dt);
}

TEST(Conservation, MomentumIsTakenByWalls) {
  Packing packing = dense_grains();
  packing.box = Box(Vector3::Zero(), {200.0, 200.0, 200.0}, Vector3::Zero(), {false, false, false});
  Stepper stepper(std::move(packing), {}, {.precision = Precision::mixed});
  const double low = extent_z(stepper.moving())[0];
  stepper.forces().walls().set({{low * Vector3::UnitZ(), Vector3::UnitZ(), Vector3::Zero()}});
  stepper.start();
  for (int step = 1; step <= 320; ++step) {
    stepper.advance(step < 320 ? Virial::none : Virial::full);
  }
  EXPECT_GT(mean_velocity(stepper)[2], 1e-4);
}

TEST(Conservation, MomentumOfAuxeticGrains) {
  Stepper stepper(nine_grains(12.0), {}, {});
  const auto momentum = [&] { return sum(take_snapshot(stepper.moving(), {.velocity = true}).velocity); };
  const Vector3 before = momentum();
  stepper.start();
  for (int step = 0; step < 500; ++step) {
    stepper.advance(step + 1 < 500 ? Virial::none : Virial::full);
  }
  EXPECT_LT((momentum() - before).norm(), 1e-11);
}

// Angular momentum of a free, damped, violently shaken grain.
TEST(Conservation, AngularMomentumOfAFreeGrain) {
  Packing packing = small_packing({.box = Box({0, 0, 0}, {40, 40, 40}, {0, 0, 0}, {false, false, false}),
                                   .n_grains = 1,
                                   .radius = 3.0,
                                   .alpha = 5.0,
                                   .speed = 0.2});
  Stepper stepper(packing, {}, {});
  const auto angular_momentum = [&] {
    const Snapshot now = take_snapshot(stepper.moving(), all_parts);
    Vector3 sum = Vector3::Zero();
    for (std::size_t i = 0; i < now.position.size(); ++i) {
      sum += (now.position[i] - Vector3(20, 20, 20)).cross(now.velocity[i]);
    }
    return sum;
  };
  stepper.start();
  const Vector3 before = angular_momentum();
  for (int step = 0; step < 1000; ++step) {
    stepper.advance(step + 1 < 1000 ? Virial::none : Virial::full);
  }
  EXPECT_LT((angular_momentum() - before).norm(), 1e-10);
}

// Without damping and many-body term there is an energy; velocity Verlet keeps it to second order in dt.
TEST(Conservation, EnergyOfAnUndampedPairwisePackingToSecondOrder) {
  const auto drift = [](double dt) {
    Stepper stepper(small_packing({.box = tilted, .n_grains = 9, .alpha = 0.0}), {.gamma = 0.0}, {.dt = dt});
    stepper.start();
    double lowest = 1e300, highest = -1e300;
    for (int step = 0; step < static_cast<int>(10.0 / dt); ++step) {
      stepper.advance(Virial::full);
      const Totals totals = totals_of(stepper.moving());
      const double energy = totals.kinetic_energy + totals.elastic_energy;
      lowest = std::min(lowest, energy);
      highest = std::max(highest, energy);
    }
    return (highest - lowest) / highest;
  };
  const double coarse = drift(0.02), fine = drift(0.01);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.4);
}

} // namespace
} // namespace boba::test
