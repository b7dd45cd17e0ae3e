// SPDX-License-Identifier: GPL-3.0-or-later
// The stress of a frame, from forces evaluated anew, against the pressure tensor that LAMMPS printed for it.
#include "bpm/app/measure/frame_stress.h"
#include "tests/support/lammps_fixture.h"

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

/// Late frames: LAMMPS's pressure belongs to the velocities half a step before the dumped ones, which are found anew.
TEST_P(FrameStressOfLammps, AgreesToRounding) {
  const Case& c = GetParam();
  const std::string name = c.cell + ".a" + c.alpha;
  Packing packing = fixture_packing(c.cell, name + "." + c.step + ".dump.gz", std::stod(c.alpha)).packing;
  Snapshot snapshot;
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
  FrameStress stress(packing, Material{}, c.step == "step0" ? 0.0 : 0.1);
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

TEST(FrameStress, RefusesAFrameOfAnotherPacking) {
  FrameStress stress(fixture_packing("tri", "tri.a2.step0.dump.gz", 2.0).packing, Material{}, 0.1);
  EXPECT_THROW(stress.evaluate(Snapshot{}), std::invalid_argument);
}

} // namespace
} // namespace boba::test
