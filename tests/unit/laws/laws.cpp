// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/laws/bond.h"
#include "bpm/laws/contact.h"
#include "bpm/laws/wall.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba {
namespace {

double bond(double alpha, double r, double r0, double volume_ratio, double vn) {
  return bond_force(1.0, alpha, 1.0, r, r0, 1.0 / r0, std::cbrt(volume_ratio), vn);
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
    EXPECT_EQ(bond_force_pairwise(1.0, 1.0, r, 1.1, 0.3), bond_force(1.0, 0.0, 1.0, r, 1.1, 1.0 / 1.1, 5.0, 0.3));
  }
}

TEST(BondLaw, ForceIsMinusGradientOfEnergyAtAlphaZero) {
  const double h = 1e-6;
  for (const double r : {0.7, 1.0, 1.4}) {
    const double slope = (bond_energy(2.0, r + h, 1.1) - bond_energy(2.0, r - h, 1.1)) / (2.0 * h);
    EXPECT_NEAR(bond_force_pairwise(2.0, 0.0, r, 1.1, 0.0), -slope, 1e-9);
  }
}

// f has the units k d: scaling k, alpha and (with it) gamma v scales f; scaling all lengths scales f with k d.
TEST(BondLaw, ScalesWithUnits) {
  const double f = bond_force(1.0, 2.0, 1.0, 1.3, 1.1, 1.0 / 1.1, 1.05, 0.2);
  EXPECT_NEAR(bond_force(3.0, 6.0, 3.0, 1.3, 1.1, 1.0 / 1.1, 1.05, 0.2), 3.0 * f, 1e-14);
  EXPECT_NEAR(bond_force(1.0, 4.0, 1.0, 2.6, 2.2, 1.0 / 2.2, 1.05, 0.4), 2.0 * f, 1e-14); // alpha is in k d
}

double contact(double r, double vn, double gamma = 1.0) {
  return contact_force(1.0, 50.0, gamma, 1.0, r, vn);
}

TEST(ContactLaw, IsContinuousAtTouch) {
  EXPECT_EQ(contact(1.0, 3.0), 0.0);
  EXPECT_NEAR(contact(1.0 - 1e-9, 3.0), 0.0, 1e-7);
}

TEST(ContactLaw, ByHand) {
  // r = 1/2: overlap 1/2, 50/8 = 6.25, s = 1 - 1/256.
  EXPECT_NEAR(contact(0.5, 0.1), 0.5 + 6.25 - 0.1 * (1.0 - 1.0 / 256.0), 1e-14);
}

TEST(ContactLaw, ForceIsMinusGradientOfEnergy) {
  const double h = 1e-6;
  for (const double r : {0.4, 0.7, 0.95}) {
    const double slope = (contact_energy(1.0, 50.0, 1.0, r + h) - contact_energy(1.0, 50.0, 1.0, r - h)) / (2.0 * h);
    EXPECT_NEAR(contact(r, 0.0, 0.0), -slope, 1e-8);
  }
}

// Hertz in its textbook form, F = 4/3 E* sqrt(R*) overlap^(3/2), 1/E* = 2 (1 - nu^2) / E, 1/R* = 2/R.
TEST(HertzLaw, IsTheTextbooksForTwoEqualSpheres) {
  const double E = 3.0, nu = 0.3, radius = 0.8, overlap = 0.05;
  const double e_star = 1.0 / (2.0 * (1.0 - nu * nu) / E), r_star = 0.5 * radius;
  EXPECT_NEAR(hertz_force(E / (2.0 - 2.0 * nu * nu), 1.0, 2.0 * radius, 2.0 * radius - overlap, 0.0),
              4.0 / 3.0 * e_star * std::sqrt(r_star) * std::pow(overlap, 1.5), 1e-14);
}

TEST(HertzLaw, ForceIsMinusGradientOfEnergyAndStiffnessItsSlope) {
  const double h = 1e-6;
  for (const double r : {0.7, 0.95, 0.999}) {
    const double slope = (hertz_energy(2.0, 1.0, r + h) - hertz_energy(2.0, 1.0, r - h)) / (2.0 * h);
    EXPECT_NEAR(hertz_force(2.0, 0.0, 1.0, r, 0.0), -slope, 1e-8);
    const double softening = hertz_force(2.0, 0.0, 1.0, r + h, 0.0) - hertz_force(2.0, 0.0, 1.0, r - h, 0.0);
    EXPECT_NEAR(hertz_stiffness(2.0, 1.0, r), -softening / (2.0 * h), 1e-5);
  }
}

// Two unit masses on a spring K move against each other with the reduced mass 1/2: critical damping is 2 sqrt(K / 2).
TEST(HertzLaw, DampsCriticallyAtGammaOne) {
  const double r = 0.99, K = hertz_stiffness(2.0, 1.0, r);
  const double damping = hertz_force(2.0, 1.0, 1.0, r, 0.0) - hertz_force(2.0, 1.0, 1.0, r, 1.0);
  EXPECT_NEAR(damping, 2.0 * std::sqrt(0.5 * K), 1e-14);
  EXPECT_EQ(hertz_force(2.0, 1.0, 1.0, 1.0, 5.0), 0.0);
}

TEST(WallLaw, IsTheContactWithOnesMirrorImage) {
  EXPECT_EQ(wall_force(1.0, 50.0, 1.0, 1.0, 0.45, -0.1), contact(0.9, -0.2));
  EXPECT_EQ(wall_force(1.0, 50.0, 1.0, 1.0, 0.5, 0.0), 0.0);
  // Stiffness per node at first touch is 2 k (the layer's c1 = 2 k n_s).
  EXPECT_NEAR(wall_force(1.0, 50.0, 0.0, 1.0, 0.5 - 1e-6, 0.0) / 1e-6, 2.0, 1e-6);
}

} // namespace
} // namespace boba
