// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/laws/bond.h"
#include "bpm/laws/contact.h"
#include "bpm/laws/hertz.h"
#include "bpm/laws/material.h"
#include "bpm/laws/wall.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba {
namespace {

constexpr BondLaw unit_bond{.k = 1.0, .gamma = 1.0};

double bond(double alpha, double r, double r0, double volume_ratio, double vn, const BondLaw& law = unit_bond) {
  return law.force(alpha, r, r0, 1.0 / r0, std::cbrt(volume_ratio), vn);
}

TEST(BondLaw, NoForceUndeformedAtRest) {
  for (const double alpha : {-0.8, 0.0, 2.0, 12.0}) {
    EXPECT_EQ(bond(alpha, 1.2, 1.2, 1.0, 0.0), 0.0);
  }
}

// A uniform stretch by s multiplies every r by s and every volume by s^3: the many-body term cancels for every alpha.
TEST(BondLaw, ManyBodyTermVanishesUnderUniformStretch) {
  for (const double s : {0.6, 0.9, 1.0, 1.3}) {
    EXPECT_NEAR(bond(12.0, 1.1 * s, 1.1, s * s * s, 0.0), 1.1 * (1.0 - s), 1e-14);
  }
}

TEST(BondLaw, ManyBodyTermByHand) {
  // q = 8: q^(1/3) = 2; r / r0 = 1.5: alpha (2 - 1.5) = 1 for alpha = 2; spring: 1 - 1.5 = -0.5; damping: -0.25.
  EXPECT_NEAR(bond(2.0, 1.5, 1.0, 8.0, 0.25), 1.0 - 0.5 - 0.25, 1e-15);
}

TEST(BondLaw, PairwiseFormIsTheFullFormAtAlphaZero) {
  for (const double r : {0.4, 1.0, 1.7}) {
    EXPECT_EQ(unit_bond.pairwise_force(r, 1.1, 1.0 / 1.1, 0.3), bond(0.0, r, 1.1, 125.0, 0.3));
  }
}

TEST(BondLaw, ForceIsMinusGradientOfEnergyAtAlphaZero) {
  const double h = 1e-6;
  const BondLaw law{.k = 2.0, .gamma = 0.0};
  for (const double r : {0.7, 1.0, 1.4}) {
    const double slope = (law.energy(r + h, 1.1) - law.energy(r - h, 1.1)) / (2.0 * h);
    EXPECT_NEAR(law.pairwise_force(r, 1.1, 1.0 / 1.1, 0.0), -slope, 1e-9);
  }
}

// f has the units k d: scaling k, alpha and (with it) gamma v scales f; scaling all lengths scales f with k d.
TEST(BondLaw, ScalesWithUnits) {
  const double f = bond(2.0, 1.3, 1.1, 1.2, 0.2);
  EXPECT_NEAR(bond(6.0, 1.3, 1.1, 1.2, 0.2, {.k = 3.0, .gamma = 3.0}), 3.0 * f, 1e-14);
  EXPECT_NEAR(bond(4.0, 2.6, 2.2, 1.2, 0.4), 2.0 * f, 1e-14); // alpha is in k d
}

// Each derivative by differences of the force in long double, whose error is h^2 f''' / 6.
constexpr long double step = 1e-6L;

/// Central difference of f about x.
template <class Function> double slope_of(Function&& f, long double x) {
  return static_cast<double>((f(x + step) - f(x - step)) / (2.0L * step));
}

TEST(BondLaw, DerivativesAreThoseOfTheForce) {
  const BondLawOf<long double> law{.k = 1.7L, .gamma = 0.6L};
  for (const long double alpha : {-0.8L, 0.0L, 12.0L}) {
    for (const long double r : {0.6L, 1.1L, 1.5L}) {
      const long double r0 = 1.1L, q = 1.07L, v = 0.3L;
      const BondSlopes<long double> slopes = law.slopes(alpha, r, r0, 1.0L / r0, q, v);
      const auto force = [&](long double at_r, long double at_q, long double at_v) {
        return law.force(alpha, at_r, r0, 1.0L / r0, at_q, at_v);
      };
      EXPECT_NEAR(slopes.by_distance, slope_of([&](auto x) { return force(x, q, v); }, r), 1e-11);
      EXPECT_NEAR(slopes.by_cbrt_ratio, slope_of([&](auto x) { return force(r, x, v); }, q), 1e-11);
      EXPECT_NEAR(slopes.by_normal_velocity, slope_of([&](auto x) { return force(r, q, x); }, v), 1e-11);
    }
  }
}

/// The same for a contact law.
template <class Law> void expect_contact_derivatives(const Law& law, std::initializer_list<long double> distances) {
  for (const long double r : distances) {
    for (const long double v : {-0.2L, 0.0L, 0.4L}) {
      const ContactSlopes<long double> slopes = law.slopes(r, v);
      const double by_r = slope_of([&](auto x) { return law.force(x, v); }, r);
      EXPECT_NEAR(slopes.by_distance, by_r, 1e-8 * (1.0 + std::abs(by_r))) << static_cast<double>(r);
      EXPECT_NEAR(slopes.by_normal_velocity, slope_of([&](auto x) { return law.force(r, x); }, v), 1e-10);
    }
    const double by_energy = slope_of([&](auto x) { return law.energy(x); }, r);
    EXPECT_NEAR(law.force(r, 0.0L), -by_energy, 1e-8 * (1.0 + std::abs(by_energy))) << static_cast<double>(r);
  }
}

double contact(double r, double vn) {
  return ContactLaw{}.force(r, vn);
}

TEST(ContactLaw, IsContinuousAtTouch) {
  EXPECT_EQ(contact(1.0, 3.0), 0.0);
  EXPECT_NEAR(contact(1.0 - 1e-9, 3.0), 0.0, 1e-7);
}

TEST(ContactLaw, ByHand) {
  // r = 1/2: overlap 1/2, 50/8 = 6.25, s = 1 - 1/256.
  EXPECT_NEAR(contact(0.5, 0.1), 0.5 + 6.25 - 0.1 * (1.0 - 1.0 / 256.0), 1e-14);
}

TEST(ContactLaw, DerivativesAreThoseOfTheForceAndTheForceThatOfTheEnergy) {
  expect_contact_derivatives(ContactLaw{.k = 1.3, .gamma = 0.7, .k3 = 20.0, .diameter = 1.1},
                             {-0.2L, 0.4L, 0.7L, 0.95L, 1.09L});
}

// Hertz in its textbook form, F = 4/3 E* sqrt(R*) overlap^(3/2), 1/E* = 2 (1 - nu^2) / E, 1/R* = 2/R.
TEST(HertzLaw, IsTheTextbooksForTwoEqualSpheres) {
  const double E = 3.0, nu = 0.3, radius = 0.8, overlap = 0.05;
  const double e_star = 1.0 / (2.0 * (1.0 - nu * nu) / E), r_star = 0.5 * radius;
  const HertzLaw law{.modulus = E / (2.0 - 2.0 * nu * nu), .diameter = 2.0 * radius};
  EXPECT_NEAR(law.force(2.0 * radius - overlap, 0.0), 4.0 / 3.0 * e_star * std::sqrt(r_star) * std::pow(overlap, 1.5),
              1e-14);
}

TEST(HertzLaw, DerivativesAreThoseOfTheForceAndTheForceThatOfTheEnergy) {
  expect_contact_derivatives(HertzLaw{.modulus = 2.0, .gamma = 0.7, .diameter = 1.1}, {-0.2L, 0.7L, 0.95L, 1.09L});
}

// Two unit masses on a spring K move against each other with the reduced mass 1/2: critical damping is 2 sqrt(K / 2).
TEST(HertzLaw, DampsCriticallyAtGammaOne) {
  const HertzLaw law{.modulus = 2.0, .gamma = 1.0};
  const double r = 0.99, K = -law.slopes(r, 0.0).by_distance;
  EXPECT_NEAR(law.force(r, 0.0) - law.force(r, 1.0), 2.0 * std::sqrt(0.5 * K), 1e-14);
  EXPECT_EQ(law.force(1.0, 5.0), 0.0);
}

TEST(WallLaw, IsTheContactWithOnesMirrorImage) {
  const ContactLaw law;
  EXPECT_EQ(wall_force(law, 0.45, -0.1), contact(0.9, -0.2));
  EXPECT_EQ(wall_force(law, 0.5, 0.0), 0.0);
  // Stiffness per node at first touch is 2 k (the layer's c1 = 2 k n_s).
  EXPECT_NEAR(wall_force(law, 0.5 - 1e-6, 0.0) / 1e-6, 2.0, 1e-6);
  EXPECT_EQ(wall_slopes(law, 0.5, 0.0).by_distance, -2.0);
  // A sphere on a plane that its mirror image meets half way: Hertz's force at twice the approach.
  EXPECT_NEAR(wall_force(HertzLaw{.modulus = 3.0}, 0.48, 0.0), 2.0 * std::pow(0.04, 1.5), 1e-14);
}

TEST(WallLaw, ForceIsMinusTheDerivativeOfTheEnergyAndItsSlopeThatOfTheForce) {
  const double h = 1e-6;
  const ContactLaw law;
  for (const double z : {-0.1, 0.3, 0.45}) {
    EXPECT_NEAR(wall_force(law, z, 0.0), -(wall_energy(law, z + h) - wall_energy(law, z - h)) / (2.0 * h), 1e-7);
    EXPECT_NEAR(wall_slopes(law, z, 0.1).by_distance,
                (wall_force(law, z + h, 0.1) - wall_force(law, z - h, 0.1)) / (2.0 * h), 1e-6);
    EXPECT_NEAR(wall_slopes(law, z, 0.1).by_normal_velocity,
                (wall_force(law, z, 0.1 + h) - wall_force(law, z, 0.1)) / h, 1e-8);
  }
}

TEST(Material, HasTheDefaultsOfItsLaws) {
  EXPECT_EQ(Material{}.k, 1.0);
  EXPECT_EQ(Material{}.gamma, 1.0);
  EXPECT_EQ(Material{}.k3, 50.0); // Clemmer, Hackney & Grest: 50 k/d^2
}

} // namespace
} // namespace boba
