// SPDX-License-Identifier: GPL-3.0-or-later
// Shear through moving images alone: what it must leave as it was.
#include "bpm/dynamics/simulation.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/shear.h"
#include "tests/physics/dynamics/nine_grains.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

constexpr double rate = 2e-2;

/// Sum of the velocities without streaming: of v - rate (y - y0) e_x.
Vector3 peculiar_sum(const Snapshot& snapshot) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < snapshot.velocity.size(); ++i) {
    sum += snapshot.velocity[i];
    sum[0] -= snapshot.streaming_rate * (snapshot.position[i][1] - snapshot.box.origin()[1]);
  }
  return sum;
}

/// Looks at the momentum and the cell at every tenth step.
class MomentumWatcher : public Observer {
public:
  bool wants(const StepForecast& forecast) override { return forecast.step % 10 == 0; }
  void observe(const Simulation& simulation, const StageProgress&) override {
    const Snapshot now = simulation.snapshot({.velocity = true});
    sums.push_back(peculiar_sum(now));
    streaming.push_back(now.streaming_rate);
    heights.push_back(now.box.lengths()[1]);
  }
  std::vector<Vector3> sums;
  std::vector<double> streaming, heights;
};

/// Nine grains away from the origin, at rest as a whole but for a motion along x.
Packing grains_at_rest() {
  Packing packing = nine_grains();
  Vector3 mean = Vector3::Zero();
  for (const Vector3& v : packing.velocity) {
    mean += v / static_cast<double>(packing.velocity.size());
  }
  for (Vector3& v : packing.velocity) {
    v += Vector3(1e-3, 0.0, 0.0) - mean;
  }
  return packing;
}

// The barostat changes the size of the packing by some per cent while it is sheared and the cell flips: momentum
// without streaming is the same in the stage, where it ends and after it, and nothing of the streaming is left.
TEST(Remap, PeculiarMomentumStays) {
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    const double tolerance = precision == Precision::full ? 1e-9 : 3e-4; // floats of 0.2 d/tau, a thousand nodes
    Simulation simulation(grains_at_rest(), {}, {.precision = precision});
    MomentumWatcher watcher;
    std::vector<Observer*> observers = {&watcher};
    const Barostat barostat = {.pressure = 0.02, .gain = 0.05};
    simulation.run(0, ShearDriver({.rate = rate, .strain = 1.2, .remap = Remap::velocities, .barostat = barostat}),
                   observers);
    EXPECT_NEAR(watcher.streaming.back(), rate, 1e-15);
    const Snapshot before = simulation.snapshot({.velocity = true});
    simulation.run(1, HoldDriver({.time = 1.0, .barostat = barostat}), observers);
    EXPECT_EQ(watcher.streaming.back(), 0.0);
    EXPECT_GT(std::abs(watcher.heights.back() / watcher.heights.front() - 1.0), 0.02);
    const Vector3 wanted(1e-3 * static_cast<double>(before.velocity.size()), 0.0, 0.0);
    for (std::size_t k = 0; k < watcher.sums.size(); ++k) {
      ASSERT_LT((watcher.sums[k] - wanted).norm(), tolerance) << "look " << k;
    }
  }
}

// Peculiar velocities are the same on both sides of the stage's ends: a cell that moves slowly is a disturbance of the
// size of its rate, not of the profile across the cell.
TEST(Remap, ProfileIsTakenAwayWhole) {
  Simulation simulation(grains_at_rest(), {}, {});
  simulation.run(0, ShearDriver({.rate = rate, .strain = 0.2, .remap = Remap::velocities}), {});
  const Snapshot before = simulation.snapshot({.velocity = true});
  simulation.run(1, HoldDriver({.time = 0.2}), {});
  const Snapshot after = simulation.snapshot({.velocity = true});
  double largest = 0.0, profile = 0.0;
  for (std::size_t i = 0; i < after.velocity.size(); ++i) {
    const double y = before.position[i][1] - before.box.origin()[1];
    largest = std::max(largest, (before.velocity[i] - Vector3(rate * y, 0.0, 0.0) - after.velocity[i]).norm());
    profile = std::max(profile, rate * y);
  }
  EXPECT_GT(profile, 0.2);
  EXPECT_LT(largest, 0.3 * profile); // what forces do in two steps
}

} // namespace
} // namespace boba::test
