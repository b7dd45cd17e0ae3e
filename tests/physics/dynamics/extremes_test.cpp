// SPDX-License-Identifier: GPL-3.0-or-later
// Runs at the edge of what makes sense: each ends with finite numbers, or is stopped by a message that names the step.
#include "bpm/dynamics/blow_up_checks.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/dynamics/stable_step.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/measure/packing_fraction.h"
#include "bpm/stages/compress.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/press.h"
#include "bpm/stages/shear.h"
#include "tests/support/small_packings.h"

#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <optional>

namespace boba::test {
namespace {

struct Outcome {
  std::optional<std::string> blow_up;
  Snapshot end;
  Totals totals;
};

/// Runs the stages; everything must stay finite, with bonds as long as grains can have, or be stopped by a message.
Outcome run(Packing packing, const std::vector<std::shared_ptr<StageDriver>>& stages, double dt = 0.1) {
  const Topology topology = packing.topology(true);
  Simulation simulation(std::move(packing), {}, {.dt = dt, .threads = 1});
  Outcome outcome;
  try {
    for (std::size_t k = 0; k < stages.size(); ++k) {
      simulation.run(static_cast<int>(k), *stages[k], {});
    }
  } catch (const BlowUp& error) {
    outcome.blow_up = error.what();
    for (const char* word : {"step", "dt"}) {
      EXPECT_NE(outcome.blow_up->find(word), std::string::npos) << *outcome.blow_up;
    }
    return outcome;
  }
  outcome.end = simulation.snapshot({.velocity = true});
  outcome.totals = simulation.totals();
  EXPECT_TRUE(std::isfinite(outcome.totals.pressure) && std::isfinite(outcome.totals.kinetic_energy));
  for (const Vector3& x : outcome.end.position) {
    EXPECT_TRUE(x.allFinite());
  }
  for (const Topology::Pair& bond : topology.bonds) {
    EXPECT_LT((outcome.end.position[bond.i] - outcome.end.position[bond.j]).norm(), 3.0 * bond.r0);
  }
  return outcome;
}

Packing grains_in(double edge, double alpha, int n = 9, double speed = 0.0) {
  return small_packing(
      {.box = Box({0, 0, 0}, {edge, edge, edge}), .n_grains = n, .alpha = alpha, .jitter = 0.0, .speed = speed});
}

CompressStage compression(double pressure) {
  return {.barostat = {.pressure = pressure},
          .rate = 2e-3,
          .pressure_tolerance = 0.02,
          .kinetic_tolerance = 0.2,
          .max_time = 5e4};
}

/// Share of the cell that is within d/2 of a node or inside a grain's hull.
double packing_fraction_of(const Snapshot& snapshot, const std::vector<std::int64_t>& first_nodes) {
  const measure::GrainNodes grains(snapshot.position, first_nodes);
  std::vector<measure::ConvexHull> hulls;
  for (int g = 0; g < grains.n_grains(); ++g) {
    hulls.push_back(measure::convex_hull(grains.nodes_of(g)));
  }
  return measure::packing_fraction(snapshot.box, grains, hulls, {.n_points = 20000}).both.value;
}

/// P = P~ E / (2 - 2 nu^2) at P~ = 1 for nu = 0.40, 0, -0.52, with the published E = 0.58, 4.05, 8.30 k/d; for the
/// softest also P~ = 4, where even the gaps between the rough surfaces of such small grains are gone.
TEST(Extremes, CompressionUntilNoGapIsLeft) {
  for (const auto& [alpha, pressure] :
       {std::pair(-0.8, 0.345), std::pair(-0.8, 1.38), std::pair(2.0, 2.03), std::pair(12.0, 5.69)}) {
    const Packing packing = grains_in(14.0, alpha);
    const Outcome outcome = run(packing, {std::make_shared<CompressDriver>(compression(pressure))});
    ASSERT_FALSE(outcome.blow_up) << alpha << ": " << *outcome.blow_up;
    EXPECT_NEAR(outcome.totals.pressure, pressure, 0.03 * pressure) << alpha;
    // Published for large grains: 0.99 at P~ = 0.5.
    EXPECT_GT(packing_fraction_of(outcome.end, packing.first_nodes()), pressure < 0.4 ? 0.9 : 0.97) << alpha;
  }
}

TEST(Extremes, FastShearWithManyFlips) {
  for (const Remap remap : {Remap::positions, Remap::velocities}) {
    const Outcome outcome =
        run(grains_in(12.0, 2.0),
            {std::make_shared<CompressDriver>(compression(0.1)),
             std::make_shared<ShearDriver>(ShearStage{
                 .rate = 1e-2, .strain = 8.0, .remap = remap, .barostat = Barostat{.pressure = 0.1, .gain = 0.05}})});
    ASSERT_FALSE(outcome.blow_up) << *outcome.blow_up;
    EXPECT_LE(std::abs(outcome.end.box.xy()), 0.5 * outcome.end.box.lengths()[0] * (1.0 + 1e-9));
    EXPECT_NEAR(outcome.end.strain, 8.0, 1e-9);
  }
}

/// In a cell one grain wide and many long a small strain flips it: every dozen steps here, through many widths of tilt.
TEST(Extremes, FlipsEveryFewSteps) {
  Packing packing = small_packing(
      {.box = Box({0, 0, 0}, {6, 72, 6}), .n_grains = 11, .jitter = 0.0, .speed = 0.0, .least_distance = 5.0});
  Stepper stepper(std::move(packing), {}, {});
  stepper.start();
  int flips = 0;
  for (int step = 0; step < 800; ++step) {
    const double xy = stepper.box().xy();
    stepper.advance(step + 1 < 800 ? Virial::trace : Virial::full);
    stepper.move_cell({.shear = 0.05, .dilation = 0.02 * (stepper.pressure() - 0.05)});
    flips += stepper.box().xy() < xy;
  }
  EXPECT_GE(flips, 40);
  EXPECT_NEAR(stepper.strain(), 4.0, 1e-9);
  EXPECT_LE(std::abs(stepper.box().xy()), 0.5 * stepper.box().lengths()[0] * (1.0 + 1e-9));
  const Snapshot end = take_snapshot(stepper.moving(), {.velocity = true});
  for (std::size_t i = 0; i < end.position.size(); ++i) {
    ASSERT_TRUE(end.position[i].allFinite());
    ASSERT_LT(end.velocity[i].norm(), 1.0); // the shear itself moves a grain's nodes apart at 0.3 d/tau
  }
  EXPECT_LT(largest_stretch(stepper.moving()).ratio, 3.0);
}

/// Lanes without a grain are moved with the others, and what is in them comes apart sooner or later: no run ends of
/// that.
TEST(Extremes, IdleLanesEndNoRun) {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    Stepper stepper(small_packing({.box = Box(Vector3::Zero(), Vector3::Constant(12.0)), .n_grains = 3}), {},
                    {.precision = precision});
    Stepper undisturbed(small_packing({.box = Box(Vector3::Zero(), Vector3::Constant(12.0)), .n_grains = 3}), {},
                        {.precision = precision});
    const MovingPacking& moving = stepper.moving();
    const Block& block = moving.layout.blocks().front();
    ASSERT_GT(block.n_lanes, 3);
    stepper.start();
    undisturbed.start();
    for (int step = 0; step < 60; ++step) {
      if (step % 20 == 10) { // faster than any node may be, then not a number
        const double speed = step == 10 ? 1e4 : std::nan("");
        stepper.moving().state.visit([&](auto& arrays) {
          arrays.v[block.offset + block.n_lanes - 1] =
              static_cast<typename std::remove_reference_t<decltype(arrays)>::Real>(speed);
        });
      }
      for (Stepper* of : {&stepper, &undisturbed}) {
        of->advance(step + 1 < 60 ? Virial::trace : Virial::full);
        of->move_cell({.shear = 1e-2});
      }
    }
    const Snapshot a = take_snapshot(stepper.moving(), {.velocity = true}),
                   b = take_snapshot(undisturbed.moving(), {.velocity = true});
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.velocity, b.velocity);
  }
}

/// Close to the limit at -1.00 short bonds collapse and their ends turn round at every step; that stays with a few
/// nodes.
TEST(Extremes, NextToTheLimitOfRigidity) {
  for (const double alpha : {-0.95, -1.0}) {
    const Outcome outcome = run(grains_in(14.0, alpha), {std::make_shared<CompressDriver>(compression(0.02)),
                                                         std::make_shared<HoldDriver>(HoldStage{.time = 100.0})});
    EXPECT_FALSE(outcome.blow_up) << alpha << ": " << *outcome.blow_up;
  }
}

TEST(Extremes, ThirtyPercentOverlapAtTheStart) {
  Packing packing = small_packing(
      {.box = Box({0, 0, 0}, {16, 16, 16}), .n_grains = 9, .jitter = 0.0, .speed = 0.0, .least_distance = 0.7 * 5.0});
  const Outcome outcome = run(std::move(packing), {std::make_shared<HoldDriver>(HoldStage{.time = 300.0})});
  if (!outcome.blow_up) {
    EXPECT_LT(outcome.totals.kinetic_energy, 1.0);
  }
}

TEST(Extremes, GrainsThroughEachOtherAtHighSpeed) {
  for (const double speed : {0.5, 2.0, 8.0}) {
    Packing packing = small_packing(
        {.box = Box({0, 0, 0}, {30, 30, 30}), .n_grains = 2, .jitter = 0.0, .speed = 0.0, .least_distance = 8.0});
    const std::int64_t n = packing.first_nodes()[1];
    Vector3 first = Vector3::Zero(), second = Vector3::Zero();
    for (std::int64_t i = 0; i < n; ++i) {
      first += packing.position[i] / static_cast<double>(n);
      second += packing.position[n + i] / static_cast<double>(n);
    }
    const Vector3 towards = packing.box.minimum_image(second - first).normalized();
    for (std::int64_t i = 0; i < n; ++i) {
      packing.velocity[i] = speed * towards;
      packing.velocity[n + i] = -speed * towards;
    }
    const Outcome outcome = run(std::move(packing), {std::make_shared<HoldDriver>(HoldStage{.time = 60.0})});
    EXPECT_TRUE(speed < 5.0 || outcome.blow_up) << "half a diameter a step must not pass in silence";
  }
}

TEST(Extremes, WallsDrivenThroughAGrain) {
  for (const double velocity : {2e-3, 0.05}) {
    Packing packing = small_packing({.box = Box({0, 0, 0}, {40, 40, 40}, {0, 0, 0}, {false, false, false}),
                                     .n_grains = 1,
                                     .jitter = 0.0,
                                     .speed = 0.0});
    run(std::move(packing), {std::make_shared<PressDriver>(PressStage{.velocity = velocity, .strain = 0.85})});
  }
}

TEST(Extremes, OneAndTwoGrainsInABoxBarelyLarger) {
  for (const int n : {1, 2}) {
    Packing packing = small_packing({.box = Box({0, 0, 0}, {5.2 * n, 5.2, 5.2}),
                                     .n_grains = n,
                                     .jitter = 0.0,
                                     .speed = 0.0,
                                     .least_distance = 5.0});
    const Outcome outcome =
        run(std::move(packing),
            {std::make_shared<CompressDriver>(compression(0.1)),
             std::make_shared<ShearDriver>(
                 ShearStage{.rate = 2e-3, .strain = 3.0, .barostat = Barostat{.pressure = 0.1, .gain = 0.05}})});
    ASSERT_FALSE(outcome.blow_up) << *outcome.blow_up;
    EXPECT_GT(outcome.totals.pressure, 0.0);
  }
}

/// Beyond the stable step of the linearised operator a run stops within 100 steps, and says that dt is a likely cause;
/// a little below it nothing happens.
TEST(Extremes, AStepBeyondTheLimitIsFoundSoon) {
  for (const double alpha : {-0.8, 0.0, 2.0, 5.0, 12.0, 20.0}) {
    const Packing packing = small_packing(
        {.box = Box({0, 0, 0}, {40, 40, 40}), .n_grains = 1, .alpha = alpha, .jitter = 0.01, .speed = 0.01});
    const double limit = stable_step(*packing.templates[0], {}, alpha);
    EXPECT_FALSE(run(packing, {std::make_shared<HoldDriver>(HoldStage{.time = 3000.0 * limit})}, 0.98 * limit).blow_up)
        << alpha;
    for (const double factor : {1.05, 1.1, 1.3, 2.0}) {
      const double dt = factor * limit;
      EXPECT_TRUE(run(packing, {std::make_shared<HoldDriver>(HoldStage{.time = 100.0 * dt})}, dt).blow_up)
          << alpha << ": dt = " << dt;
    }
  }
}

/// Deep contacts take less than bonds do. Such a run does not explode, it vibrates: that is found too.
TEST(Extremes, AStepBeyondTheLimitOfDeepContactsIsFoundSoon) {
  Packing packing = grains_in(14.0, -0.8);
  const Outcome pressed = run(packing, {std::make_shared<CompressDriver>(compression(0.345))});
  ASSERT_FALSE(pressed.blow_up);
  packing.box = pressed.end.box;
  packing.position = pressed.end.position;
  packing.velocity = pressed.end.velocity;
  const double of_bonds = stable_step(*packing.templates[0], {}, -0.8);
  EXPECT_FALSE(run(packing, {std::make_shared<HoldDriver>(HoldStage{.time = 300.0})}, 0.1).blow_up);
  EXPECT_TRUE(
      run(packing, {std::make_shared<HoldDriver>(HoldStage{.time = 100.0 * of_bonds})}, 0.99 * of_bonds).blow_up);
}

} // namespace
} // namespace boba::test
