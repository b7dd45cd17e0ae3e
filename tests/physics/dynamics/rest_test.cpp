// SPDX-License-Identifier: GPL-3.0-or-later
// Packings brought to rest, and strained in steps at rest.
#include "bpm/dynamics/fire.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/quasistatic.h"
#include "bpm/stages/relax.h"
#include "tests/physics/dynamics/nine_grains.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

using Kind = ComponentDrive::Kind;

RelaxStage relaxation(RestPlan::Method method = RestPlan::Method::fire, double tolerance = 1e-9) {
  RelaxStage stage;
  stage.rest = {method, tolerance, 1e5};
  stage.cell.kind = "relax";
  stage.cell.time = 2e5;
  return stage;
}

Packing with(Packing packing, const Snapshot& state) {
  packing.position = state.position;
  packing.velocity = state.velocity;
  packing.box = state.box;
  return packing;
}

/// Largest net force when everything is evaluated again from the positions alone.
double force_at_rest(const Snapshot& state) {
  Packing packing = with(nine_grains(), state);
  std::fill(packing.velocity.begin(), packing.velocity.end(), Vector3::Zero());
  Simulation simulation(packing, {}, {});
  simulation.evaluate();
  double largest = 0.0;
  for (const Vector3& f : simulation.snapshot({.force = true}).force) {
    largest = std::max(largest, f.norm());
  }
  return largest;
}

RelaxStage at_pressure(double pressure) {
  RelaxStage stage = relaxation();
  stage.cell.pressure = Barostat{.pressure = pressure};
  for (int c = 0; c < 3; ++c) {
    stage.cell.component[c].kind = Kind::pressure;
  }
  return stage;
}

/// A dense state at rest, without loose grains, whose cell is then strained by 1e-4: what rest has to mend in a
/// loading.
Packing slightly_strained() {
  Simulation simulation(nine_grains(), {}, {});
  simulation.run(0, RelaxDriver(at_pressure(0.2)), {});
  DeformStage strain{.time = 0.1};
  strain.component[3].kind = Kind::strain;
  strain.component[3].path = {.duration = 0.1, .rate_from = 1e-3, .rate = 1e-3};
  simulation.run(1, DeformDriver(strain), {});
  simulation.run(2, HoldDriver({.time = 0.1}), {});
  return with(nine_grains(), simulation.snapshot(all_parts));
}

TEST(Rest, FireEndsWhereDampingDoes) {
  const Packing start = slightly_strained();
  Simulation fast(start, {}, {}), slow(start, {}, {});
  fast.run(0, RelaxDriver(relaxation(RestPlan::Method::fire, 1e-8)), {});
  slow.run(0, RelaxDriver(relaxation(RestPlan::Method::damping, 1e-8)), {});
  const Snapshot a = fast.snapshot(all_parts), b = slow.snapshot(all_parts);
  double largest = 0.0;
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    largest = std::max(largest, (a.position[i] - b.position[i]).norm());
    EXPECT_LT(a.velocity[i].norm(), 1e-9);
  }
  EXPECT_LT(largest, 1e-4);
  EXPECT_LT(force_at_rest(a), 1e-8);
  EXPECT_LT(force_at_rest(b), 1e-8);
}

TEST(Rest, HoldsPressureAndStress) {
  Simulation simulation(nine_grains(), {}, {});
  simulation.run(0, RelaxDriver(at_pressure(0.05)), {});
  EXPECT_NEAR(simulation.totals().pressure, 0.05, 1e-4 * 0.05);
  EXPECT_LT(force_at_rest(simulation.snapshot(all_parts)), 1e-9);
  RelaxStage along_z = relaxation();
  along_z.cell.component[2].kind = Kind::stress;
  along_z.cell.component[2].stress = -0.07;
  simulation.run(1, RelaxDriver(along_z), {});
  EXPECT_NEAR(simulation.totals().stress[2], -0.07, 1e-4 * 0.07);
  EXPECT_LT(force_at_rest(simulation.snapshot(all_parts)), 1e-9);
}

TEST(Rest, FailsWhenItDoesNotSettle) {
  RelaxStage stage = relaxation();
  stage.rest.max_time = 1.0;
  Simulation simulation(nine_grains(), {}, {});
  try {
    simulation.run(0, RelaxDriver(stage), {});
    FAIL() << "no packing rests after 10 steps";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("not at rest after max_time = 1 tau"), std::string::npos) << error.what();
  }
}

QuasistaticStage in_steps() {
  QuasistaticStage stage;
  stage.rest = {RestPlan::Method::fire, 1e-6, 1e5};
  stage.cell.kind = "quasistatic";
  stage.cell.component[3].kind = Kind::strain;
  stage.cell.component[3].path.amplitude = 0.02;
  stage.component = 3;
  stage.steps = 4;
  return stage;
}

/// The same bits for any threads, and after a stop at any moment.
template <class Driver, class Stage> void expect_reproducible(const Stage& stage, const std::vector<int>& stops) {
  Simulation whole(nine_grains(), {}, {}), threaded(nine_grains(), {}, {.threads = 3});
  whole.run(0, Driver(stage), {});
  threaded.run(0, Driver(stage), {});
  const Snapshot end = whole.snapshot(all_parts);
  expect_same_bits(end, threaded.snapshot(all_parts));
  for (const int stop : stops) {
    Simulation first(nine_grains(), {}, {}), second(nine_grains(), {}, {});
    Driver of_first(stage), of_second(stage);
    ASSERT_EQ(first.run(0, of_first, {}, [&] { return first.step() == stop; }), RunOutcome::stopped) << stop;
    second.restore(first.save());
    ASSERT_EQ(second.run(0, of_second, {}), RunOutcome::finished);
    expect_same_bits(end, second.snapshot(all_parts));
  }
}

TEST(Rest, IsTheSameForThreadsAndRestarts) {
  RelaxStage held = relaxation(RestPlan::Method::fire, 1e-2);
  held.stress_tolerance = 0.1;
  held.cell.component[0].kind = Kind::stress;
  held.cell.component[0].stress = -0.05;
  expect_reproducible<RelaxDriver>(held, {1, 20, 133});
  expect_reproducible<QuasistaticDriver>(in_steps(), {1, 33, 400});
}

/// The modulus of the steps at rest is that of a slow shear in the same state.
TEST(Rest, QuasistaticStrainIsCounted) {
  Simulation simulation(nine_grains(), {}, {});
  QuasistaticDriver driver(in_steps());
  simulation.run(0, driver, {});
  ASSERT_EQ(driver.table()->rows.size(), 5U);
  EXPECT_NEAR(simulation.strain(), 0.02, 1e-14);
  EXPECT_NEAR(driver.table()->rows.back().values[4], simulation.totals().stress[3], 1e-12);
  EXPECT_NEAR(simulation.box().xy() - tilted.xy(), 0.02 * tilted.lengths()[1], 1e-12);
}

} // namespace
} // namespace boba::test
