// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/packing_numbers.h"
#include "tests/support/small_packings.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace boba::test {
namespace {

// Source of rate, diameter and pressure: the published study; I = 1.6e-5 * 20 * sqrt(rho / P), by hand.
TEST(InertialNumber, OfAPublishedRate) {
  const double pressure = 0.1 * 1.84 / (2.0 - 2.0 * 0.0625);
  const double density = 5137.0 / (4.0 / 3.0 * std::numbers::pi * 1000.0);
  EXPECT_NEAR(inertial_number(1.6e-5, 20.0, density, pressure), 1.1313e-3, 1e-7);
  EXPECT_NEAR(inertial_number(-1.6e-5, 20.0, density, pressure), 1.1313e-3, 1e-7);
}

TEST(InertialNumber, IsZeroWithoutShearAndUnknownWithoutPressure) {
  EXPECT_EQ(inertial_number(0.0, 20.0, 1.0, 0.0), 0.0);
  EXPECT_TRUE(std::isnan(inertial_number(1e-3, 20.0, 1.0, 0.0)));
  EXPECT_TRUE(std::isnan(inertial_number(1e-3, 20.0, 1.0, -0.1)));
}

TEST(PackingNumbers, AreThoseOfTheMeanGrain) {
  Packing packing;
  packing.templates = {small_ball(1.5, 1), small_ball(2.0, 2)};
  packing.grains = {Grain{.template_index = 0}, Grain{.template_index = 1}};
  const double volume_0 = packing.template_of(0).reference_volume, volume_1 = packing.template_of(1).reference_volume;
  const int n = packing.template_of(0).n_nodes() + packing.template_of(1).n_nodes();
  const PackingNumbers numbers(packing, Material{.node_mass = 2.0}, 0.5);
  EXPECT_DOUBLE_EQ(numbers.reference_volume, volume_0 + volume_1);
  EXPECT_NEAR(std::numbers::pi / 6.0 * std::pow(numbers.grain_diameter, 3), 0.5 * (volume_0 + volume_1), 1e-12);
  EXPECT_DOUBLE_EQ(numbers.density, 2.0 * n / (volume_0 + volume_1));
  EXPECT_DOUBLE_EQ(numbers.normalised(0.1), 0.2);
  EXPECT_DOUBLE_EQ(numbers.phi_reference(Box(Vector3::Zero(), Vector3::Constant(10.0))),
                   numbers.reference_volume / 1000.0);
}

} // namespace
} // namespace boba::test
