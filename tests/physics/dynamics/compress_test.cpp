// SPDX-License-Identifier: GPL-3.0-or-later
// How a compression comes to rest at its pressure.
#include "bpm/dynamics/simulation.h"
#include "bpm/stages/compress.h"
#include "tests/support/small_packings.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace boba::test {
namespace {

/// Pressure and volume at every step of the settling.
class SettlingWatcher : public Observer {
public:
  struct Moment {
    double time, pressure, volume;
  };
  bool wants(const StepForecast&) override { return true; }
  void observe(const Simulation& simulation, const StageProgress& progress) override {
    if (progress.phase == "settle") {
      moments.push_back({simulation.time(), simulation.totals().pressure, simulation.box().volume()});
    }
  }
  std::vector<Moment> moments;
};

// The barostat's answer time 1 / (3 K g), against the modulus K that the settling itself shows: soft grains rearrange
// and answer with a fraction of the affine modulus (a tenth in the ramp, still less later).
TEST(Compress, SoftPackingsSettleInTheBarostatsTime) {
  Simulation simulation(
      small_packing({.box = Box({0, 0, 0}, {13, 13, 13}), .n_grains = 9, .alpha = -0.8, .jitter = 0.0, .speed = 0.0}),
      {}, {.threads = 2});
  const double target = 0.05;
  SettlingWatcher watcher;
  std::vector<Observer*> observers = {&watcher};
  CompressDriver stage({.barostat = {.pressure = target}, .rate = 1e-3, .pressure_tolerance = 5e-3});
  ASSERT_EQ(simulation.run(0, stage, observers), RunOutcome::finished);
  const auto& moments = watcher.moments;
  const auto lowest = std::min_element(moments.begin(), moments.end(),
                                       [](const auto& a, const auto& b) { return a.pressure < b.pressure; });
  const auto closer = std::find_if(lowest, moments.end(), [&](const auto& moment) {
    return target - moment.pressure < 0.2 * (target - lowest->pressure);
  });
  ASSERT_NE(closer, moments.end());
  const double modulus = (closer->pressure - lowest->pressure) / std::log(lowest->volume / closer->volume);
  const double answer =
      (closer->time - lowest->time) / std::log((target - lowest->pressure) / (target - closer->pressure));
  const double n_nodes = static_cast<double>(simulation.packing().first_nodes().back());
  const double crossing = std::cbrt(closer->volume) / std::sqrt(modulus * closer->volume / n_nodes);
  const double expected = std::max(100.0, 3.0 * crossing);
  EXPECT_GT(answer, expected / 3.0);
  EXPECT_LT(answer, expected * 3.0); // with the affine modulus it is eleven times as long
}

} // namespace
} // namespace boba::test
