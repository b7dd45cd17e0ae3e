// SPDX-License-Identifier: GPL-3.0-or-later
// Whole runs: flips, threads, restarts, stages, walls, blow-up.
#include "bpm/dynamics/simulation.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/stages/compress.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/press.h"
#include "bpm/stages/shear.h"
#include "tests/physics/dynamics/nine_grains.h"
#include "tests/support/plain_forces.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <utility>

namespace boba::test {
namespace {

/// Asks for the whole stress at every `interval`-th step.
class Watcher : public Observer {
public:
  explicit Watcher(std::int64_t interval) : interval_(interval) {}
  bool wants(const StepForecast& forecast) override { return forecast.step % interval_ == 0; }
  void observe(const Simulation& simulation, const StageProgress&) override {
    pressures.push_back(simulation.totals().pressure);
  }
  std::vector<double> pressures;

private:
  std::int64_t interval_;
};

ShearStage shear_stage(Remap remap = Remap::positions) {
  return {.rate = 2e-2, .strain = 0.6, .remap = remap, .barostat = Barostat{.pressure = 0.05, .gain = 0.05}};
}

Snapshot sheared(int threads, std::int64_t watch = 1000000, Remap remap = Remap::positions,
                 Precision precision = Precision::full) {
  Simulation simulation(nine_grains(), {}, {.threads = threads, .precision = precision});
  Watcher watcher(watch);
  std::vector<Observer*> observers = {&watcher};
  simulation.run(0, ShearDriver(shear_stage(remap)), observers);
  return simulation.snapshot(all_parts);
}

TEST(Runs, DoNotDependOnThreads) {
  const Snapshot one = sheared(1);
  const Snapshot one_mixed = sheared(1, 1000000, Remap::positions, Precision::mixed);
  for (const int threads : {2, 3, 4}) {
    expect_same_bits(one, sheared(threads));
    expect_same_bits(one_mixed, sheared(threads, 1000000, Remap::positions, Precision::mixed));
  }
}

// Three grains are one block, which the threads share; that needs grains large enough.
TEST(Runs, DoNotDependOnThreadsThatShareABlock) {
  const Box box(Vector3::Zero(), {26.0, 25.0, 27.0}, {9.0, -7.0, 8.0});
  const auto run = [&](int threads, Precision precision) {
    Packing packing = small_packing({.box = box, .n_grains = 3, .radius = 6.5, .least_distance = 11.0});
    EXPECT_GT(packing.templates.front()->n_nodes(), 1000);
    Stepper stepper(std::move(packing), {}, {.threads = threads, .precision = precision});
    stepper.start();
    for (int step = 0; step < 30; ++step) {
      stepper.advance(step % 3 == 2 ? Virial::full : Virial::trace);
    }
    return std::make_pair(take_snapshot(stepper.moving(), all_parts), stepper.forces().grain_sums());
  };
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    const auto [one, sums_of_one] = run(1, precision);
    for (const int threads : {2, 3, 5}) {
      const auto [several, sums] = run(threads, precision);
      expect_same_bits(one, several);
      for (std::size_t g = 0; g < sums.size(); ++g) {
        EXPECT_EQ(sums[g].virial, sums_of_one[g].virial);
        EXPECT_EQ(sums[g].kinetic, sums_of_one[g].kinetic);
        EXPECT_EQ(sums[g].virial_trace, sums_of_one[g].virial_trace);
      }
    }
  }
}

// Positions agree as long as the trajectories have not parted: chaos multiplies a float's rounding.
TEST(Runs, MixedPrecisionFollowsDouble) {
  for (const Remap remap : {Remap::positions, Remap::velocities}) {
    Stepper exact(nine_grains(), {}, {}), mixed(nine_grains(), {}, {.precision = Precision::mixed});
    for (Stepper* stepper : {&exact, &mixed}) {
      stepper->start();
      for (int step = 0; step < 100; ++step) {
        stepper->advance(step + 1 < 100 ? Virial::trace : Virial::full);
        stepper->move_cell({.shear = 0.02, .remap = remap, .dilation = 0.05 * (stepper->pressure() - 0.05)});
      }
    }
    const Snapshot a = take_snapshot(exact.moving(), all_parts), b = take_snapshot(mixed.moving(), all_parts);
    double largest = 0.0;
    for (std::size_t i = 0; i < a.position.size(); ++i) {
      largest = std::max(largest, (a.position[i] - b.position[i]).norm());
    }
    EXPECT_LT(largest, 1e-4);
    EXPECT_GT(largest, 0.0); // it is mixed precision that was run
    EXPECT_NEAR(totals_of(exact.moving()).pressure, totals_of(mixed.moving()).pressure,
                1e-5 * totals_of(exact.moving()).pressure);
    EXPECT_NEAR(totals_of(exact.moving()).mu(), totals_of(mixed.moving()).mu(), 1e-4);
  }
}

TEST(Runs, DoNotDependOnWhoIsWatching) {
  expect_same_bits(sheared(2), sheared(2, 7));
}

TEST(Runs, ContinueBitForBitFromAnyStep) {
  for (const auto& [remap, precision] :
       {std::pair(Remap::positions, Precision::full), std::pair(Remap::velocities, Precision::full),
        std::pair(Remap::positions, Precision::mixed)}) {
    const Snapshot whole = sheared(2, 1000000, remap, precision);
    for (const std::int64_t stop_at : {1, 2, 37, 150, 299}) {
      Simulation first(nine_grains(), {}, {.threads = 2, .precision = precision});
      ASSERT_EQ(first.run(0, ShearDriver(shear_stage(remap)), {}, [&] { return first.step() == stop_at; }),
                RunOutcome::stopped);
      const SavedState saved = first.save();
      Simulation second(nine_grains(), {}, {.threads = 1, .precision = precision});
      second.restore(saved);
      EXPECT_EQ(second.stage_index(), 0);
      second.run(0, ShearDriver(shear_stage(remap)), {});
      expect_same_bits(whole, second.snapshot(all_parts));
    }
  }
}

// Stopped after each of 130 steps in a row: the cell flips among them, and the steps are there at which momentum is
// mended (64) and much else is looked at (50).
TEST(Runs, StopAtEveryStepInMixedPrecision) {
  for (const Remap remap : {Remap::positions, Remap::velocities}) {
    const Snapshot whole = sheared(1, 1000000, remap, Precision::mixed);
    constexpr std::int64_t first = 25, last = 155;
    SavedState saved;
    double xy = tilted.xy();
    int flips = 0;
    for (std::int64_t stop = first; stop <= last; ++stop) {
      Simulation part(nine_grains(), {}, {.threads = 1 + static_cast<int>(stop % 2), .precision = Precision::mixed});
      if (stop > first) {
        part.restore(saved);
      }
      ASSERT_EQ(part.run(0, ShearDriver(shear_stage(remap)), {}, [&] { return part.step() == stop; }),
                RunOutcome::stopped);
      saved = part.save();
      flips += part.box().xy() < xy - 1.0 ? 1 : 0;
      xy = part.box().xy();
    }
    EXPECT_GE(flips, 1);
    Simulation rest(nine_grains(), {}, {.threads = 2, .precision = Precision::mixed});
    rest.restore(saved);
    rest.run(0, ShearDriver(shear_stage(remap)), {});
    expect_same_bits(whole, rest.snapshot(all_parts));
  }
}

// The same lattice in other cell vectors: a flip must change nothing. The barostat is on, so that the pressure is in
// the loop.
TEST(Runs, FlipChangesNothing) {
  Stepper flipping(nine_grains(), {}, {});
  Box upright = tilted;
  Matrix3 h = upright.h();
  h.col(1) -= h.col(0); // xy: 5 -> -7, beyond half of Lx = 12: flipped back at the first move of the cell
  upright.set_h(h);
  Packing other = nine_grains();
  other.box = upright;
  Stepper leaning(other, {}, {});
  int flips = 0;
  for (Stepper* stepper : {&flipping, &leaning}) {
    stepper->start();
  }
  for (int step = 0; step < 300; ++step) {
    for (Stepper* stepper : {&flipping, &leaning}) {
      const double xy = stepper->box().xy();
      stepper->advance(step + 1 < 300 ? Virial::trace : Virial::full); // the last step keeps its forces
      stepper->move_cell({.shear = 0.05, .dilation = 0.05 * (stepper->pressure() - 0.05)});
      flips += std::abs(stepper->box().xy() - xy) > 1.0;
    }
  }
  EXPECT_GE(flips, 3);
  const Snapshot a = take_snapshot(flipping.moving(), all_parts), b = take_snapshot(leaning.moving(), all_parts);
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    ASSERT_LT((a.position[i] - b.position[i]).norm(), 1e-8);
    ASSERT_LT((a.force[i] - b.force[i]).norm(), 1e-8);
  }
  EXPECT_NEAR(flipping.pressure(), leaning.pressure(), 1e-9);
}

TEST(Runs, FlipLeavesForcesAndPositionsAlone) {
  Packing packing = nine_grains();
  Box box = packing.box;
  Matrix3 h = box.h();
  h.col(2) += h.col(1);
  h.col(1) += 2.0 * h.col(0);
  box.set_h(h);
  packing.box = box;
  Box flipped = box;
  ASSERT_TRUE(flipped.flip());
  Packing same = packing;
  same.box = flipped;
  Stepper a(packing, {}, {}), b(same, {}, {});
  a.evaluate_only();
  b.evaluate_only();
  const Snapshot sa = take_snapshot(a.moving(), all_parts), sb = take_snapshot(b.moving(), all_parts);
  for (std::size_t i = 0; i < sa.force.size(); ++i) {
    EXPECT_EQ(sa.position[i], sb.position[i]);
    EXPECT_LT((sa.force[i] - sb.force[i]).norm(), 1e-12);
  }
}

// Right at the limit of a flip, a rounding more and less; in a cell as thin as it may be, too. Forces are those of all
// pairs and images in long double, and the run that follows does not know on which side it began.
TEST(Runs, TiltsAtTheLimitOfAFlip) {
  for (const Vector3& lengths : {Vector3(12.0, 11.0, 13.0), Vector3(30.0, 6.5, 6.2), Vector3(6.4, 30.0, 6.1)}) {
    for (const double sign : {1.0, -1.0}) {
      std::vector<Snapshot> ends;
      for (const double share : {1.0 - 1e-15, 1.0, 1.0 + 1e-15}) {
        const Vector3 tilts(sign * 0.5 * lengths[0] * share, -0.3 * lengths[0], 0.4 * lengths[1]);
        const Box box(Vector3(0.3, -1.0, 2.0), lengths, tilts);
        Packing packing =
            small_packing({.box = Box(box.origin(), lengths, {sign * 0.5 * lengths[0], tilts[1], tilts[2]}),
                           .n_grains = 3,
                           .radius = 2.0,
                           .least_distance = 3.5});
        packing.box = box;
        Stepper stepper(packing, {}, {});
        stepper.evaluate_only();
        const Snapshot start = take_snapshot(stepper.moving(), all_parts);
        const PlainForces plain = plain_forces(packing, {}, 3);
        for (std::size_t i = 0; i < plain.force.size(); ++i) {
          ASSERT_LT((start.force[i] - plain.force[i]).norm(), 1e-10) << "tilt " << tilts[0] << ", node " << i;
        }
        Stepper moving(packing, {}, {});
        moving.start();
        for (int step = 0; step < 100; ++step) {
          moving.advance(step + 1 < 100 ? Virial::trace : Virial::full);
          moving.move_cell({.shear = sign * 1e-3});
        }
        ends.push_back(take_snapshot(moving.moving(), all_parts));
      }
      for (std::size_t i = 0; i < ends[0].position.size(); ++i) {
        ASSERT_LT((ends[0].position[i] - ends[1].position[i]).norm(), 1e-8);
        ASSERT_LT((ends[2].position[i] - ends[1].position[i]).norm(), 1e-8);
      }
    }
  }
}

TEST(Runs, CompressSettlesAtItsPressure) {
  Simulation simulation(
      small_packing({.box = Box({0, 0, 0}, {13, 13, 13}), .n_grains = 9, .jitter = 0.0, .speed = 0.0}), {},
      {.threads = 2});
  CompressDriver driver({.barostat = {.pressure = 0.05}, .rate = 2e-3});
  ASSERT_EQ(simulation.run(0, driver, {}), RunOutcome::finished);
  simulation.run(1, HoldDriver({.time = 0.1}), {});
  Watcher watcher(1);
  std::vector<Observer*> observers = {&watcher};
  simulation.run(2, HoldDriver({.time = 0.1}), observers);
  EXPECT_NEAR(simulation.totals().pressure / 0.05, 1.0, 2e-3);
  EXPECT_LT(simulation.totals().kinetic_energy, 2e-4 * simulation.totals().elastic_energy);
}

// A grain on a wall is half of two mirror-image grains in contact, while no node touches a neighbour's image.
// Whenever the ramp ends in a step at which settling is looked at, too: the totals of the end are those of its step.
TEST(Runs, CompressEndsWhereItSaidItMight) {
  for (int k = 0; k < 40; ++k) {
    CompressStage stage{.barostat = {.pressure = 0.2, .gain = 0.05}, .rate = 4e-3 * (1.0 + 0.01 * k)};
    stage.pressure_tolerance = 0.9;
    stage.kinetic_tolerance = 1e3;
    Simulation simulation(nine_grains(), {}, {});
    simulation.run(0, CompressDriver(stage), {});
    EXPECT_NO_THROW(simulation.snapshot(all_parts)) << k;
  }
}

TEST(Runs, WallIsTheMirrorImage) {
  auto ball = small_ball(2.5, 3);
  auto mirrored = std::make_shared<GrainTemplate>(*ball);
  double lowest = 0.0;
  for (Vector3& x : mirrored->position) {
    lowest = std::min(lowest, x[2]);
    x[2] = -x[2];
  }
  const Box open({-20, -20, -20}, {40, 40, 40}, {0, 0, 0}, {false, false, false});
  const double gap = 0.47; // from the plane z = 0 to the lowest node: it overlaps with its image
  Placement above, below;
  above.grain.alpha = below.grain.alpha = 2.0;
  below.grain.template_index = 1;
  above.centre[2] = -lowest + gap;
  below.centre[2] = lowest - gap;
  Stepper pair(make_packing(open, {ball, mirrored}, {above, below}), {}, {});
  Stepper wall(make_packing(open, {ball}, {above}), {}, {});
  wall.forces().walls().set({Wall{}});
  pair.start();
  wall.start();
  for (int step = 0; step < 50; ++step) {
    pair.advance(Virial::full);
    wall.advance(Virial::full);
  }
  const Snapshot a = take_snapshot(pair.moving(), all_parts), b = take_snapshot(wall.moving(), all_parts);
  EXPECT_GT(wall.forces().contact_totals().largest_overlap, 0.0);
  double moved = 0.0;
  for (std::size_t i = 0; i < b.position.size(); ++i) {
    EXPECT_LT((a.position[i] - b.position[i]).norm(), 1e-12);
    moved = std::max(moved, b.velocity[i].norm());
  }
  EXPECT_GT(moved, 1e-3);
}

TEST(Runs, PressBetweenClampsStretchesAsAsked) {
  const Box open({-20, -20, -20}, {40, 40, 40}, {0, 0, 0}, {false, false, false});
  Simulation simulation(make_packing(open, {small_ball(4.0, 5)}, {Placement{}}), {}, {});
  const PressStage stage = {.ends = PressStage::Ends::clamps, .velocity = 0.01, .strain = 0.05, .clamp_thickness = 1.5};
  simulation.run(0, PressDriver(stage), {});
  double low = 1e300, high = -1e300;
  for (const Vector3& x : simulation.packing().position) {
    low = std::min(low, x[2]);
    high = std::max(high, x[2]);
  }
  const double free_height = high - low - 2.0 * stage.clamp_thickness;
  EXPECT_NEAR(simulation.end_gap(), 0.95 * free_height, 2.0 * stage.velocity * 0.1); // to one step
  EXPECT_GT(simulation.end_forces()[0], 0.0);                                        // squeezed ends push apart
  EXPECT_NEAR(simulation.end_forces()[0], simulation.end_forces()[1], 0.2 * simulation.end_forces()[1]);
}

TEST(Runs, ShearStrainAndTiltAgree) {
  const Snapshot end = sheared(1);
  EXPECT_NEAR(end.strain, 0.6, 1e-12);
  EXPECT_EQ(end.step, 300);
}

TEST(Runs, BlowUpNamesNodeGrainStepAndCause) {
  Packing packing = nine_grains();
  packing.velocity[100] = {80.0, 0.0, 0.0};
  Simulation simulation(packing, {}, {});
  try {
    simulation.run(0, HoldDriver({.time = 10.0}), {});
    FAIL() << "a node at 8 d a step was not noticed";
  } catch (const BlowUp& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("step 1"), std::string::npos) << message;
    EXPECT_NE(message.find("node"), std::string::npos) << message;
    EXPECT_NE(message.find("grain"), std::string::npos) << message;
    EXPECT_NE(message.find("dt"), std::string::npos) << message;
  }
}

TEST(Runs, NotANumberIsNoticedAtOnce) {
  Packing packing = nine_grains();
  packing.position[5][1] = std::nan("");
  Simulation simulation(packing, {}, {});
  EXPECT_THROW(simulation.run(0, HoldDriver({.time = 10.0}), {}), BlowUp);
}

TEST(Runs, TooLargeATimeStepIsNoticedWithinAHundredSteps) {
  Simulation simulation(
      small_packing({.box = Box({0, 0, 0}, {14, 14, 14}), .n_grains = 9, .alpha = 12.0, .jitter = 1e-3}), {},
      {.dt = 0.6});
  EXPECT_THROW(simulation.run(0, HoldDriver({.time = 1000.0}), {}), BlowUp);
  EXPECT_LE(simulation.step(), 100);
}

} // namespace
} // namespace boba::test
