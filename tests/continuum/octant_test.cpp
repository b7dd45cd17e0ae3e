// SPDX-License-Identifier: GPL-3.0-or-later
// The octant in three dimensions against exact states and against the axisymmetric solver.
#include "continuum/cylinder/cylinder.h"
#include "continuum/octant/mpi_session.h"
#include "continuum/octant/octant_body.h"
#include "continuum/sphere/sphere.h"
#include "verification_row.h"

#include <numbers>

namespace boba::continuum::testing {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// u = (a sin x cos y cos z, b cos x sin y cos z, c cos x cos y sin z): mirror-symmetric about the three planes.
struct Manufactured {
  static constexpr double a = 1, b = -0.7, c = 0.4;
  double shear, lame;

  static Vector3d value(const Vector3d& x) {
    return {a * std::sin(x[0]) * std::cos(x[1]) * std::cos(x[2]), b * std::cos(x[0]) * std::sin(x[1]) * std::cos(x[2]),
            c * std::cos(x[0]) * std::cos(x[1]) * std::sin(x[2])};
  }
  static Matrix3d gradient(const Vector3d& x) {
    const Vector3d s = x.array().sin(), k = x.array().cos();
    Matrix3d h;
    h << a * k[0] * k[1] * k[2], -a * s[0] * s[1] * k[2], -a * s[0] * k[1] * s[2], //
        -b * s[0] * s[1] * k[2], b * k[0] * k[1] * k[2], -b * k[0] * s[1] * s[2],  //
        -c * s[0] * k[1] * s[2], -c * k[0] * s[1] * s[2], c * k[0] * k[1] * k[2];
    return h;
  }
  /// -div sigma = -(mu lap u + (lambda + mu) grad div u), with lap u = -3 u and div u = (a + b + c) cos x cos y cos z.
  Vector3d force(const Vector3d& x) const {
    const Vector3d s = x.array().sin(), k = x.array().cos();
    const Vector3d slope(s[0] * k[1] * k[2], k[0] * s[1] * k[2], k[0] * k[1] * s[2]);
    return 3 * shear * value(x) + (lame + shear) * (a + b + c) * slope;
  }
};

Eigen::Vector2d error_of(const Discretisation& discretisation, unsigned refinements) {
  const Material material{1, 0.3};
  const Manufactured exact{material.shear(), material.lame()};
  OctantShape sphere;
  sphere.refinements = refinements;
  OctantBody body(sphere, discretisation);
  body.solve_prescribed(material, Manufactured::value, [&](const Vector3d& x) { return exact.force(x); });
  return body.error(Manufactured::value, Manufactured::gradient);
}

TEST(Octant, ManufacturedSolutionConvergesAtTheOrderOfTheElement) {
  const std::pair<Discretisation, const char*> elements[] = {{{1, Formulation::displacement}, "Q1"},
                                                             {{2, Formulation::displacement}, "Q2"},
                                                             {{2, Formulation::projected}, "Q2 projected"}};
  for (const auto& [element, name] : elements) {
    const unsigned fine = element.degree == 1 ? 4 : 3;
    const Eigen::Vector2d order =
        (error_of(element, fine - 1).array() / error_of(element, fine).array()).log() / std::log(2.);
    const std::string what = fmt::format("manufactured, three dimensions {}", name);
    verify({what + ": order in L2", order[0], element.degree + 1., 0.1, "order p + 1", true});
    verify({what + ": order in H1", order[1], double(element.degree), 0.1, "order p", true});
  }
}

TEST(Octant, SlidingCylinderIsUniaxialStress) {
  for (const unsigned degree : {1u, 2u}) {
    OctantBody body({1, 2, 1}, {degree});
    const OctantSolution solution = body.solve_held({3, 0.3}, 0.02, false);
    // The faceted disc has its own area: the modulus is exact per area, so the radial strain is held instead.
    verify({fmt::format("octant Q{}: sliding cylinder, radial strain", degree), solution.profile.front().u_r, 0.003,
            1e-6, "nu eps R (conjugate gradients to 1e-9)"});
  }
  OctantBody body({1, 2, 2}, {2});
  verify({"octant Q2: sliding cylinder, F", body.solve_held({3, 0.3}, 0.02, false).force, 0.03 * std::numbers::pi, 1e-4,
          "E eps pi R^2"});
}

TEST(Octant, BothMultigridsSolveTheSameSystem) {
  OctantBody aggregated({1, 2, 2}, {1}, Multigrid::gamg), classical({1, 2, 2}, {1}, Multigrid::boomer);
  verify({"octant: hypre BoomerAMG against PETSc GAMG, F", classical.solve_held({1, 0.3}, 0.02, true).force,
          aggregated.solve_held({1, 0.3}, 0.02, true).force, 1e-7, "conjugate gradients to 1e-9"});
}

TEST(Octant, BondedCylinderAgreesWithTheMeridian) {
  for (const double nu : {-0.5, 0.4, 0.49}) {
    OctantBody body({1, 2, 2}, {2});
    const OctantSolution solution = body.solve_held({1, nu}, 0.02, true);
    CylinderProblem problem;
    problem.material = {1, nu};
    problem.strains = {0.01};
    const auto flat = solve(problem).loads.front();
    const std::string what = fmt::format("octant against meridian, bonded cylinder, nu = {}: ", nu);
    verify({what + "F", solution.force, flat.force, 5e-3, "axisymmetric solver"});
    verify({what + "Poisson ratio at mid-height", solution.profile.front().u_r / 0.01, flat.midheight_poisson, 5e-3,
            "axisymmetric solver"});
  }
}

TEST(Octant, SphereAgreesWithTheMeridian) {
  for (const double nu : {-0.5, 0.25, 0.49}) {
    SphereProblem problem;
    problem.material = {1, nu};
    problem.approaches = {0.04};
    const SphereLoad flat = solve(problem).front();
    OctantShape shape = graded_sphere(1, 0.9 * flat.contact_radius, 1.1 * flat.contact_radius, 10);
    shape.refinements = 1;
    OctantBody body(shape, {2});
    const OctantSolution solution = body.press(problem.material, 0.98, 1.1 * flat.contact_radius);
    const std::string what = fmt::format("octant against meridian, sphere, nu = {}, approach 0.04: ", nu);
    const std::string source = "axisymmetric solver";
    verify({what + "F", solution.force, flat.force, 5e-3, source});
    verify({what + "a", solution.contact_radius, flat.contact_radius, 5e-3, source});
    verify({what + "p0", solution.central_pressure, flat.central_pressure, 5e-3, source});
    verify({what + "bulge", solution.profile.front().u_r, flat.equatorial_bulge, 5e-3, source});
  }
}

} // namespace
} // namespace boba::continuum::testing

int main(int argc, char** argv) {
  const boba::continuum::MpiSession session;
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
