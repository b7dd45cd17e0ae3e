// SPDX-License-Identifier: GPL-3.0-or-later
// Deformations of the cell by component: volume, flips, held stresses, work, and the same bits for threads and
// restarts.
#include "bpm/archive/archive.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/io/input_error.h"
#include "bpm/stages/deform.h"
#include "bpm/stages/hold.h"
#include "tests/physics/dynamics/nine_grains.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

using Kind = ComponentDrive::Kind;

/// Every component in its own way: a ramp of the rate, a servo, a length that keeps the volume, cycles of a tilt.
DeformStage everything_at_once() {
  DeformStage stage{.time = 20.0, .measure = StrainMeasure::logarithmic, .servo = {.gain = 0.02}};
  stage.component[0].kind = Kind::strain;
  stage.component[0].path = {.duration = 20.0, .rate_from = 0.0, .rate = -6e-3};
  stage.component[1].kind = Kind::volume;
  stage.component[2].kind = Kind::stress;
  stage.component[2].stress = -0.05;
  stage.component[2].from_present = true;
  stage.component[3].kind = Kind::strain;
  stage.component[3].path = {.kind = PrescribedStrain::Kind::sine, .duration = 20.0, .amplitude = 0.3, .cycles = 1.5};
  stage.component[5].kind = Kind::stress;
  stage.component[5].stress = 0.01;
  return stage;
}

Snapshot deformed(const DeformStage& stage, int threads) {
  Simulation simulation(nine_grains(), {}, {.threads = threads});
  simulation.run(0, DeformDriver(stage), {});
  return simulation.snapshot(all_parts);
}

TEST(Deform, DoesNotDependOnThreads) {
  const Snapshot one = deformed(everything_at_once(), 1);
  expect_same_bits(one, deformed(everything_at_once(), 3));
}

TEST(Deform, ContinuesBitForBitFromAnyStep) {
  const Snapshot whole = deformed(everything_at_once(), 1);
  for (const int stop : {1, 57, 131, 199}) {
    Simulation first(nine_grains(), {}, {}), second(nine_grains(), {}, {});
    DeformDriver of_first(everything_at_once()), of_second(everything_at_once());
    ASSERT_EQ(first.run(0, of_first, {}, [&] { return first.step() == stop; }), RunOutcome::stopped);
    second.restore(first.save());
    ASSERT_EQ(second.run(0, of_second, {}), RunOutcome::finished);
    expect_same_bits(whole, second.snapshot(all_parts));
  }
}

/// One length keeps the volume against one or two that are strained, or two share it.
TEST(Deform, KeepsTheVolumeToRounding) {
  for (const int n_following : {1, 2}) {
    for (const StrainMeasure measure : {StrainMeasure::engineering, StrainMeasure::logarithmic}) {
      DeformStage stage{.time = 100.0, .measure = measure};
      stage.component[0].kind = Kind::strain;
      stage.component[0].path = {.duration = 100.0, .rate_from = 1e-3, .rate = 3e-3};
      stage.component[4].kind = Kind::strain;
      stage.component[4].path = {.duration = 100.0, .rate_from = 1e-2, .rate = 1e-2};
      for (int c = 1; c <= n_following; ++c) {
        stage.component[c].kind = Kind::volume;
      }
      Simulation simulation(nine_grains(), {}, {});
      const Box before = simulation.box();
      simulation.run(0, DeformDriver(stage), {});
      const Box& after = simulation.box();
      EXPECT_NEAR(after.volume(), before.volume(), 1e-12 * before.volume());
      const double growth = measure == StrainMeasure::engineering ? 1.2 : std::exp(0.2);
      EXPECT_NEAR(after.lengths()[0], growth * before.lengths()[0], 1e-12 * before.lengths()[0]);
      EXPECT_NEAR(after.lengths()[1], before.lengths()[1] * std::pow(growth, -1.0 / n_following), 1e-11);
      EXPECT_NEAR(simulation.strain(), measure == StrainMeasure::engineering ? 1.0 : 1.0, 1e-12) << "that of xz";
    }
  }
}

/// Tilts of all three kinds, far enough for several flips: the same lattice, so the same forces as in the cell that was
/// never flipped, which is known from the strains alone.
TEST(Deform, FlipsOfAllTiltsChangeNoForce) {
  for (const int tilt : {3, 4, 5}) {
    DeformStage stage{.time = 40.0};
    stage.component[tilt].kind = Kind::strain;
    stage.component[tilt].path = {.duration = 40.0, .rate_from = 2e-2, .rate = 2e-2};
    Simulation simulation(nine_grains(), {}, {});
    simulation.run(0, DeformDriver(stage), {});
    const Box& box = simulation.box();
    Matrix3 f = Matrix3::Identity();
    f(component_place[tilt][0], component_place[tilt][1]) = 0.8;
    const Matrix3 smooth = f * tilted.h(), now = box.h();
    const Matrix3 n = now.inverse() * smooth; // whole numbers of lattice vectors
    EXPECT_LT((n - n.array().round().matrix()).cwiseAbs().maxCoeff(), 1e-9) << n;
    EXPECT_GT((smooth - now).cwiseAbs().maxCoeff(), 1.0) << "nothing was flipped";
    EXPECT_LE(std::abs(box.xy()), 0.5 * box.lengths()[0]);
    EXPECT_LE(std::abs(box.xz()), 0.5 * box.lengths()[0]);
    EXPECT_LE(std::abs(box.yz()), 0.5 * box.lengths()[1]);
    const Snapshot end = simulation.snapshot(all_parts);
    Packing again = nine_grains();
    again.position = end.position;
    again.velocity = end.velocity;
    // The forces of the end belong to the cell before the last step's motion: one 400th of the strain less.
    f(component_place[tilt][0], component_place[tilt][1]) = 0.8 * 399.0 / 400.0;
    again.box.set_h(f * tilted.h());
    for (std::size_t i = 0; i < again.velocity.size(); ++i) {
      again.velocity[i] -= 0.05 * end.force[i]; // forces see half-step velocities
    }
    Simulation plain(again, {}, {});
    plain.evaluate();
    const Snapshot same = plain.snapshot({.force = true});
    double largest = 0.0;
    for (std::size_t i = 0; i < end.force.size(); ++i) {
      largest = std::max(largest, (same.force[i] - end.force[i]).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(largest, 1e-9) << cell_components[tilt];
  }
}

TEST(Deform, HoldsNormalAndShearStresses) {
  DeformStage stage{.time = 3000.0}; // after half of it one stress is still off by 5e-4
  for (int c = 0; c < 6; ++c) {
    stage.component[c].kind = Kind::stress;
    stage.component[c].stress = c < 3 ? -0.1 - 0.01 * c : 0.004 * (c - 4);
  }
  Simulation simulation(nine_grains(), {}, {});
  simulation.run(0, DeformDriver(stage), {});
  for (int c = 0; c < 6; ++c) {
    EXPECT_NEAR(simulation.totals().stress[c], stage.component[c].stress, 1e-4) << cell_components[c];
  }
}

struct Balance {
  double work = 0.0, gained = 0.0; ///< k d^2
};

/// Small: at rest the energy of the violent start is off by 140 dt^2 k d^2 after 20 tau (0.0086, 0.0022 at 0.01,
/// 0.005).
constexpr double time_step = 0.0025;

/// Without damping and with alpha = 0; all rates of the six components times `factor`.
Balance balance_of(double factor) {
  DeformStage stage{.time = 20.0};
  const double rates[] = {-2e-3, -1e-3, -1e-3, 4e-3, -3e-3, 2e-3};
  for (int c = 0; c < 6; ++c) {
    stage.component[c].kind = Kind::strain;
    stage.component[c].path = {.duration = 20.0, .rate_from = factor * rates[c], .rate = factor * rates[c]};
  }
  Stepper stepper(nine_grains(0.0), {.gamma = 0.0}, {.dt = time_step});
  DeformDriver driver(stage);
  stepper.start();
  driver.begin(stepper);
  const auto energy = [&] {
    const Totals totals = totals_of(stepper.moving());
    return totals.kinetic_energy + totals.elastic_energy;
  };
  // Velocities are those beside the cell's motion, so the kinetic part of the stress does no work.
  const auto power_of = [&](const Matrix3& gradient) {
    double power = 0.0;
    for (const GrainSums& grain : stepper.forces().grain_sums()) {
      for (int c = 0; c < 6; ++c) {
        power -= grain.virial[c] * gradient(component_place[c][0], component_place[c][1]);
      }
    }
    return power;
  };
  stepper.advance(Virial::full);
  Balance balance{.gained = -energy()};
  // Each motion of the cell works against the mean of the forces before and after it.
  while (!driver.finished()) {
    const CellRates rates = driver.update(stepper);
    stepper.move_cell(rates);
    balance.work += 0.5 * time_step * power_of(rates.gradient);
    stepper.advance(Virial::full);
    balance.work += 0.5 * time_step * power_of(rates.gradient);
  }
  balance.gained += energy();
  return balance;
}

/// What the cell does is the energy that the packing gains: dW = V sigma : grad v dt.
TEST(Deform, TheCellsWorkIsTheEnergy) {
  EXPECT_NEAR(balance_of(0.0).gained, 0.0, 2e-3);
  for (const double factor : {1.0, -1.0, -2.0}) {
    const Balance balance = balance_of(factor);
    EXPECT_GT(std::abs(balance.gained), 0.1);
    EXPECT_NEAR(balance.work, balance.gained, 0.01 * std::abs(balance.gained) + 2e-3) << factor;
  }
}

TEST(Deform, RefusesAStrainThatEndsBeforeIt) {
  DeformStage stage{.time = 1000.0};
  stage.component[0].kind = Kind::strain;
  stage.component[0].path = {.duration = 1000.0, .rate_from = 1e-2, .rate = 1e-2};
  stage.component[1].kind = Kind::volume;
  Simulation simulation(nine_grains(), {}, {});
  const double half = 0.5 * std::cbrt(6.0 * nominal_volume(nine_grains().templates.front()->n_nodes()) / M_PI);
  try {
    simulation.run(0, DeformDriver(stage), {});
    FAIL() << "a cell as thin as half a grain was not refused";
  } catch (const InputError& error) {
    // Ly (1 + e)^-1 is half a grain there.
    const std::string expected = fmt::format("ends at {:.4g}", tilted.lengths()[1] / half - 1.0);
    EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what() << expected;
    EXPECT_NE(std::string(error.what()).find("along y"), std::string::npos) << error.what();
  }
  EXPECT_EQ(simulation.step(), 0);
}

TEST(Deform, StopsWhereAServoMakesTheCellTooThin) {
  DeformStage stage{.time = 1e5, .servo = {.gain = 10.0, .rate_cap = 0.02}};
  stage.component[2].kind = Kind::stress;
  stage.component[2].stress = -50.0;
  Simulation simulation(nine_grains(), {}, {.dt = 0.02});
  try {
    simulation.run(0, DeformDriver(stage), {});
    FAIL() << "a cell thinner than half a grain was not noticed";
  } catch (const BlowUp&) {
    FAIL() << "blew up before";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("too thin"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("across z"), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace boba::test
