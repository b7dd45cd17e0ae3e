// SPDX-License-Identifier: GPL-3.0-or-later
// The stress of a frame, from forces evaluated again, against the pressure tensor that LAMMPS printed for it.
#include "bpm/app/measure/frame_stress.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/stages/shear.h"
#include "tests/support/lammps_fixture.h"
#include "tests/support/small_packings.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

struct Case {
  std::string cell, alpha, step;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.cell << " alpha " << c.alpha << " " << c.step;
}

std::array<double, 6> pressure(FrameStress& stress, const Snapshot& snapshot) {
  std::array<double, 6> sum{};
  for (const auto& grain : stress.evaluate(snapshot)) {
    for (std::size_t c = 0; c < sum.size(); ++c) {
      sum[c] -= grain[c] / snapshot.box.volume();
    }
  }
  return sum;
}

class FrameStressOfLammps : public testing::TestWithParam<Case> {};

/// Late frames: LAMMPS's pressure belongs to the velocities half a step before the dumped ones, which are found again.
TEST_P(FrameStressOfLammps, AgreesToRounding) {
  const Case& c = GetParam();
  const std::string name = c.cell + ".a" + c.alpha;
  Packing packing = fixture_packing(c.cell, name + "." + c.step + ".dump.gz", std::stod(c.alpha)).packing;
  Snapshot snapshot;
  snapshot.step = std::stoi(c.step.substr(std::string("step").size()));
  snapshot.box = packing.box;
  snapshot.position = packing.position;
  snapshot.velocity = packing.velocity;
  for (Vector3& x : packing.position) {
    x.setConstant(std::nan("")); // the evaluation takes the snapshot's
  }
  const std::array<double, 6> expected = lammps_pressure(name + ".press.txt", c.step);
  double largest = 0.0;
  for (const double p : expected) {
    largest = std::max(largest, std::abs(p));
  }
  FrameStress stress(packing, Material{}, 0.1);
  const std::array<double, 6> found = pressure(stress, snapshot);
  const double tolerance = 1e-10 * largest; // the dumps hold 17 digits
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_NEAR(found[k], expected[k], tolerance) << "component " << k;
  }
  snapshot.velocity.clear();
  EXPECT_GT(std::abs(pressure(stress, snapshot)[0] - expected[0]),
            1e-3 * largest); // damping and kinetic parts are gone
}

INSTANTIATE_TEST_SUITE_P(Fixtures, FrameStressOfLammps,
                         testing::Values(Case{"ortho", "-0.8", "step0"}, Case{"tri", "0", "step0"},
                                         Case{"tri", "12", "step0"}, Case{"ortho", "2", "step10"},
                                         Case{"tri", "2", "step10"}, Case{"ortho", "12", "step100"}));

/// Compares the stress of every frame with that of the run at the same step.
class FrameChecker : public Observer {
public:
  FrameChecker(const Packing& packing, double dt) : stress_(packing, Material{}, dt) {}
  bool wants(const StepForecast& forecast) override { return forecast.step % 25 == 0; }
  void observe(const Simulation& simulation, const StageProgress&) override {
    const Snapshot frame = simulation.snapshot({.velocity = true});
    const std::array<double, 6> found = pressure(stress_, frame);
    for (std::size_t c = 0; c < found.size(); ++c) {
      largest_difference = std::max(largest_difference, std::abs(found[c] + simulation.totals().stress[c]));
    }
    largest_pressure = std::max(largest_pressure, std::abs(simulation.totals().pressure));
    ++n_frames;
  }
  double largest_difference = 0.0, largest_pressure = 0.0;
  int n_frames = 0;

private:
  FrameStress stress_;
};

// A fast shear with a barostat and flips of the cell: a frame whose positions belonged to another step's cell would be
// off by a modulus times rate times dt, 1e-3 of the pressure.
TEST(FrameStress, IsTheRunsOwn) {
  const Packing packing =
      small_packing({.box = Box(Vector3::Zero(), {12.0, 11.0, 12.0}, {5.0, -4.0, 3.0}), .n_grains = 9, .alpha = 2.0});
  for (const Remap remap : {Remap::positions, Remap::velocities}) {
    Simulation simulation(packing, {}, {});
    FrameChecker checker(packing, 0.1);
    std::vector<Observer*> observers = {&checker};
    const ShearStage stage = {
        .rate = 2e-2, .strain = 0.6, .remap = remap, .barostat = Barostat{.pressure = 0.05, .gain = 0.05}};
    simulation.run(0, ShearDriver(stage), observers);
    EXPECT_GT(checker.n_frames, 10);
    EXPECT_LT(checker.largest_difference, 1e-9 * checker.largest_pressure);
  }
}

TEST(FrameStress, RefusesAFrameOfAnotherPacking) {
  FrameStress stress(fixture_packing("tri", "tri.a2.step0.dump.gz", 2.0).packing, Material{}, 0.1);
  EXPECT_THROW(stress.evaluate(Snapshot{}), std::invalid_argument);
}

} // namespace
} // namespace boba::test
