// SPDX-License-Identifier: GPL-3.0-or-later
// Packings between rigid walls, and gravity: free fall, the weight on the floor, the work of a press and its way back.
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/stages/press.h"
#include "tests/physics/dynamics/nine_grains.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace boba::test {
namespace {

constexpr double g = 1e-3; ///< d/tau^2

/// Small grains in a box with walls at its faces, far from touching each other and the walls.
Packing in_a_box(int n_grains, const std::array<bool, 3>& walls = {true, true, true}) {
  Packing packing =
      small_packing({.box = Box({1, 2, 3}, {16, 17, 24}, Vector3::Zero(), {!walls[0], !walls[1], !walls[2]}),
                     .n_grains = n_grains,
                     .jitter = 0.0,
                     .speed = 0.0,
                     .least_distance = 6.5});
  Vector3 low = Vector3::Constant(1e300), high = -low;
  for (const Vector3& x : packing.position) {
    low = low.cwiseMin(x - Vector3::Constant(0.5));
    high = high.cwiseMax(x + Vector3::Constant(0.5));
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (!walls[axis]) {
      low[axis] = packing.box.origin()[axis];
      high[axis] = low[axis] + packing.box.lengths()[axis];
    }
  }
  packing.box = Box(low, high - low, Vector3::Zero(), packing.box.periodic());
  packing.walls = walls;
  return packing;
}

Material with_gravity() {
  Material material;
  material.gravity = {0.0, 0.0, -g};
  return material;
}

double mean_z(const Stepper& stepper) {
  const Snapshot now = take_snapshot(stepper.moving(), {});
  double sum = 0.0;
  for (const Vector3& x : now.position) {
    sum += x.z();
  }
  return sum / static_cast<double>(now.position.size());
}

// From rest, velocity Verlet follows z = -g t^2 / 2 without an error of the step.
TEST(Gravity, FreeFallIsExact) {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    const Packing packing = small_packing({.box = Box({0, 0, 0}, {40, 40, 40}, Vector3::Zero(), {false, false, false}),
                                           .n_grains = 2,
                                           .jitter = 0.0,
                                           .speed = 0.0,
                                           .least_distance = 15.0});
    Stepper stepper(packing, with_gravity(), {.precision = precision});
    const double begin = mean_z(stepper);
    stepper.start();
    constexpr int n_steps = 100;
    for (int step = 0; step < n_steps; ++step) {
      stepper.advance(step + 1 < n_steps ? Virial::none : Virial::full);
      stepper.move_cell({});
    }
    const double t = n_steps * stepper.options().dt;
    EXPECT_NEAR(mean_z(stepper) - begin, -0.5 * g * t * t, precision == Precision::full ? 1e-11 : 1e-5);
  }
}

TEST(Gravity, TheFloorCarriesTheWeight) {
  const Packing packing = in_a_box(6);
  Stepper stepper(packing, with_gravity(), {});
  stepper.start();
  double floor = 0.0, ceiling = 0.0;
  constexpr int n_steps = 30000, averaged = 5000;
  for (int step = 0; step < n_steps; ++step) {
    stepper.advance(Virial::none);
    stepper.move_cell({});
    if (step >= n_steps - averaged) {
      floor += stepper.ends().forces()[0] / averaged;
      ceiling += stepper.ends().forces()[1] / averaged;
    }
  }
  const double weight = g * static_cast<double>(packing.position.size());
  EXPECT_NEAR(floor, weight, 0.01 * weight);
  EXPECT_EQ(ceiling, 0.0);
}

/// Presses, step by step as a stage does; returns the mean force on the ends after each step.
std::vector<double> press(Stepper& stepper, double velocity, double strain) {
  PressDriver driver({.velocity = velocity, .strain = strain});
  driver.begin(stepper);
  std::vector<double> forces;
  while (!driver.finished()) {
    stepper.advance(Virial::full);
    stepper.move_cell(driver.update(stepper));
    const auto [lower, upper] = stepper.ends().forces();
    forces.push_back(0.5 * (lower + upper));
  }
  driver.end(stepper);
  return forces;
}

TEST(Walls, APackingIsPressedAndTheWallsGoBack) {
  for (const std::array<bool, 3>& walls : {std::array{false, false, true}, std::array{true, true, true}}) {
    Stepper stepper(in_a_box(8, walls), {}, {});
    const double height = stepper.ends().gap();
    stepper.start();
    const std::vector<double> in = press(stepper, 5e-3, 0.8);
    EXPECT_EQ(in.front(), 0.0);
    EXPECT_GT(in.back(), 0.5);
    EXPECT_NEAR(stepper.ends().gap(), 0.2 * height, 0.05);
    EXPECT_NEAR(stepper.moving().cell.box().lengths()[2], stepper.ends().gap(), 1e-12); // volumes follow the walls
    const Snapshot end = take_snapshot(stepper.moving(), {});
    double low = 1e300, high = -1e300;
    for (const Vector3& x : end.position) {
      low = std::min(low, x.z());
      high = std::max(high, x.z());
    }
    EXPECT_LT(high - low, stepper.ends().wall_distance()); // nobody passed a wall
    // The walls go back from where they are: the force does not jump, but for damping, and is
    // gone before they are back.
    const std::vector<double> out = press(stepper, -5e-3, 0.8);
    EXPECT_NEAR(out.front(), in.back(), 0.1 * in.back());
    EXPECT_LT(out.back(), 0.1 * in.back()); // grains that swing touch a wall now and then
  }
}

TEST(Walls, AllOfThemHoldTheGrainsAndAreKeptInACheckpoint) {
  Packing packing = in_a_box(8);
  for (std::size_t i = 0; i < packing.velocity.size(); ++i) { // the grains fly apart
    packing.velocity[i] = 0.02 * (packing.position[i] - packing.box.origin() - 0.5 * packing.box.lengths());
  }
  Stepper stepper(packing, {}, {}), continued(packing, {}, {});
  stepper.start();
  const auto run = [](Stepper& moving, int n_steps) {
    for (int step = 0; step < n_steps; ++step) {
      moving.advance(step + 1 < n_steps ? Virial::none : Virial::full);
      moving.move_cell({});
    }
  };
  run(stepper, 500);
  continue_from(stepper, continued);
  run(stepper, 1500);
  run(continued, 1500);
  const Snapshot end = take_snapshot(stepper.moving(), all_parts);
  expect_same_bits(end, take_snapshot(continued.moving(), all_parts));
  for (const Vector3& x : end.position) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(x[axis], packing.box.origin()[axis]);
      EXPECT_LT(x[axis], packing.box.origin()[axis] + packing.box.lengths()[axis]);
    }
  }
}

} // namespace
} // namespace boba::test
