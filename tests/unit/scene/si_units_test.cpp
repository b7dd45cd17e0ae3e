// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/scene/si_units.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <stdexcept>

namespace boba {
namespace {

PoissonTable table() {
  return PoissonTable(BOBA_SOURCE_DIR "/calibration/table.toml");
}

/// A hydrogel bead of 3 mm and 20 kPa.
SiGrain bead() {
  return {.young = 20e3, .poisson = 0.25, .diameter = 3e-3, .density = 1000.0, .nodes = 1000};
}

TEST(SiUnits, GrainKeepsItsMassVolumeAndModulus) {
  const SiGrain grain = bead();
  const SiUnits units = si_units(grain, table());
  const double volume = std::numbers::pi / 6.0 * grain.diameter * grain.diameter * grain.diameter;
  EXPECT_NEAR(grain.nodes * units.mass, grain.density * volume, 1e-12 * grain.density * volume);
  EXPECT_NEAR(units.young * units.pressure(), grain.young, 1e-9);
  // Speed of a bar's longitudinal wave: sqrt(E / rho) in both systems, rho = 1.226 m/d^3.
  EXPECT_NEAR(std::sqrt(units.young / 1.226) * units.velocity(), std::sqrt(grain.young / grain.density), 1e-9);
}

TEST(SiUnits, BeadOf3MillimetresAnd20KilopascalByHand) {
  const SiUnits units = si_units(bead(), table());
  // d: (6 x 1000 / (pi 1.226))^(1/3) = 11.592 d across. LAMMPS, cube of 10976 nodes at nu = 0.2506: E = 1.8652 k/d.
  EXPECT_NEAR(units.length, 3e-3 / 11.592, 2e-8);
  EXPECT_NEAR(units.stiffness, 20e3 * units.length / 1.8652, 0.005 * units.stiffness);
  EXPECT_NEAR(units.alpha, 0.0, 0.02);
  EXPECT_NEAR(units.time(), std::sqrt(units.mass / units.stiffness), 1e-15);
}

TEST(SiUnits, InertialNumberIsThatOfTheEngine) {
  const SiGrain grain = bead();
  const SiUnits units = si_units(grain, table());
  const double rate = 0.01, pressure = 500.0;
  const double engine =
      rate * units.time() * (grain.diameter / units.length) * std::sqrt(1.226 / (pressure / units.pressure()));
  EXPECT_NEAR(inertial_number_of(grain, rate, pressure), engine, 1e-12 * engine);
  EXPECT_THROW(inertial_number_of(grain, rate, 0.0), std::invalid_argument);
}

TEST(SiUnits, ImpossibleNumbersAreRefused) {
  SiGrain grain = bead();
  grain.poisson = 0.49;
  EXPECT_THROW(si_units(grain, table()), InputError);
  for (double SiGrain::*field : {&SiGrain::young, &SiGrain::diameter, &SiGrain::density}) {
    for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
      SiGrain wrong = bead();
      wrong.*field = bad;
      EXPECT_THROW(si_units(wrong, table()), std::invalid_argument);
    }
  }
  grain = bead();
  grain.nodes = 0;
  EXPECT_THROW(si_units(grain, table()), std::invalid_argument);
}

} // namespace
} // namespace boba
