// SPDX-License-Identifier: GPL-3.0-or-later
// The octant in three dimensions against exact states and against the axisymmetric solver.
#include "continuum/cylinder/cylinder.h"
#include "continuum/elasticity/octant_body.h"
#include "continuum/sphere/sphere.h"

#include "verification_row.h"

#include <numbers>

namespace boba::continuum::testing {
namespace {

TEST(Octant, SlidingCylinderIsUniaxialStress) {
  for (const unsigned degree : {1u, 2u}) {
    OctantBody body({1, 2, 1}, degree);
    const OctantSolution solution = body.solve_held({3, 0.3}, 0.02, false);
    // The faceted disc has its own area: the modulus is exact per area, so the radial strain is held instead.
    verify({fmt::format("octant Q{}: sliding cylinder, radial strain", degree), solution.midheight_radial, 0.003, 1e-6,
            "nu eps R (conjugate gradients to 1e-9)"});
  }
  OctantBody body({1, 2, 2}, 2);
  verify({"octant Q2: sliding cylinder, F", body.solve_held({3, 0.3}, 0.02, false).force, 0.03 * std::numbers::pi, 1e-4,
          "E eps pi R^2"});
}

TEST(Octant, BondedCylinderAgreesWithTheMeridian) {
  for (const double nu : {-0.5, 0.4}) {
    OctantBody body({1, 2, 2}, 2);
    const OctantSolution solution = body.solve_held({1, nu}, 0.02, true);
    CylinderProblem problem;
    problem.material = {1, nu};
    const auto flat = solve(problem).loads.front();
    verify({fmt::format("octant against meridian, bonded cylinder, nu = {}: F", nu), solution.force, flat.force, 5e-3,
            "axisymmetric solver"});
  }
}

TEST(Octant, SphereAgreesWithTheMeridian) {
  SphereProblem problem;
  problem.material = {1, 0.25};
  problem.approaches = {0.04};
  const SphereLoad flat = solve(problem).front();
  SphereMeshSize size;
  size.lowest_edge = 0.9 * flat.contact_radius;
  size.highest_edge = 1.1 * flat.contact_radius;
  size.elements_across = 8;
  size.elements_inside = 5;
  size.growth = 0.5;
  OctantShape shape;
  shape.refinements = 1;
  shape.wanted = [&](double x, double y, double z) { return wanted_size(std::hypot(x, y), z, 0, 1, size); };
  OctantBody body(shape, 2);
  const OctantSolution solution = body.press(problem.material, 0.98, 1.1 * flat.contact_radius);
  verify({"octant against meridian, sphere, nu = 0.25, approach 0.04: F", solution.force, flat.force, 5e-3,
          "axisymmetric solver"});
  report("octant against meridian, sphere: a (as an area)", solution.contact_radius, flat.contact_radius,
         "axisymmetric solver");
}

} // namespace
} // namespace boba::continuum::testing

int main(int argc, char** argv) {
  const boba::continuum::MpiSession session;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
