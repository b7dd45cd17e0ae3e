// SPDX-License-Identifier: GPL-3.0-or-later
// The static solver under laws from outside the tree.
#include "bpm/grain/random.h"
#include "calibration/network/network_stiffness.h"
#include "calibration/specimen/nonlinear_network.h"
#include "tests/calibration/test_boxes.h"
#include "tests/support/other_laws.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

using test::ParabolicContact;
using test::StiffeningBond;

const NetworkLaws others = {std::make_shared<PlainBondOf<StiffeningBond>>(StiffeningBond{}),
                            std::make_shared<PlainContactOf<ParabolicContact>>(ParabolicContact{})};

// Nearest neighbours of a face-centred crystal, nothing relaxes: C11 = sqrt(2) times the stiffness of a bond, C12 = C44
// = C11 / 2. All r0 = 1: with springs 2 k + alpha and the volume term 2 alpha q^(1/3) per bond, C11 and C12 lose 2
// alpha (C11 + 2 C12) / 3 of the unit spring.
TEST(OtherLaws, StaticStiffnessOfACrystalFollowsTheBondLaw) {
  const LinearNetwork network(fcc_box(4), *others.bond);
  const double c11 = std::sqrt(2.0), c12 = 0.5 * c11;
  for (const double alpha : {0.0, 0.7}) {
    const Stiffness c = relaxed_stiffness(network, {alpha}).front().stiffness;
    const double volume_part = 2.0 * alpha * (c11 + 2.0 * c12) / 3.0;
    EXPECT_NEAR(c(0, 0), c11 * (2.0 + alpha) - volume_part, 1e-9);
    EXPECT_NEAR(c(0, 1), c12 * (2.0 + alpha) - volume_part, 1e-9);
    EXPECT_NEAR(c(3, 3), c12 * (2.0 + alpha), 1e-9);
  }
}

// At finite strain, where cubic and many-body terms count, and with contacts and walls.
TEST(OtherLaws, JacobianOfTheNonlinearNetworkIsTheDerivativeOfItsForces) {
  const GrainTemplate cylinder = test_cylinder(4.0, 9.0);
  NonlinearNetwork network(cylinder, 3.0, others);
  std::vector<Vector3> position = network.position();
  Random random(5);
  for (Vector3& x : position) {
    x = 0.9 * x + random.vector(0.03);
  }
  network.set_positions(position);
  double low = 0.0, high = 0.0;
  for (const Vector3& x : position) {
    low = std::min(low, x.z());
    high = std::max(high, x.z());
  }
  network.set_walls(low - 0.3, high + 0.3);
  std::vector<Vector3> u;
  for (std::size_t n = 0; n < position.size(); ++n) {
    u.push_back(random.vector(1.0));
  }
  EXPECT_GT(network.wall_loads()[0], 0.0);
  const auto moved = [&](double h) {
    std::vector<Vector3> x = position;
    for (std::size_t n = 0; n < x.size(); ++n) {
      x[n] += h * u[n];
    }
    return network.forces(x);
  };
  const double h = 1e-6;
  network.linearise();
  const auto plus = moved(h), minus = moved(-h), ours = network.force_derivative(u);
  double largest = 0.0, error = 0.0;
  for (std::size_t n = 0; n < u.size(); ++n) {
    const Vector3 slope = (plus[n] - minus[n]) / (2.0 * h);
    largest = std::max(largest, slope.norm());
    error = std::max(error, (slope - ours[n]).norm());
  }
  EXPECT_LT(error, 1e-7 * largest);
  // Two nodes on a bond: f = 2 (r0 - r) + 7 (r0 - r)^3 + alpha (q^(2/3) - r / r0) with q^(1/3) = r / r0.
  const NonlinearNetwork pair({{{-0.5, 0.0, 0.0}, {0.5, 0.0, 0.0}}, {{0, 1, 1.0}}, std::nullopt, 1.0}, 3.0, others);
  const auto force = pair.forces({{-0.4, 0.0, 0.0}, {0.4, 0.0, 0.0}});
  EXPECT_NEAR(force[1].x(), 0.4 + 0.056 + 3.0 * (0.64 - 0.8), 1e-14);
}

} // namespace
} // namespace boba::calibration
