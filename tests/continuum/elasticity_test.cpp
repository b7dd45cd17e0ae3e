// SPDX-License-Identifier: GPL-3.0-or-later
// The axisymmetric elements: orders of convergence with a manufactured solution, and no locking near nu = 1/2.
#include "continuum/cylinder/cylinder_mesh.h"
#include "continuum/elasticity/meridian_body.h"
#include "verification_row.h"

#include <numbers>

namespace boba::continuum::testing {
namespace {

/// u_r = r g cos z, u_z = g sin z with g = (1 - r^2)^2: no traction at r = 1 and on the mid plane.
struct Manufactured {
  double shear, lame;

  static double g(double r) { return (1 - r * r) * (1 - r * r); }
  static double g1(double r) { return -4 * r * (1 - r * r); }
  static double g2(double r) { return 12 * r * r - 4; }

  static Eigen::Vector2d value(double r, double z) { return {r * g(r) * std::cos(z), g(r) * std::sin(z)}; }
  static Gradient gradient(double r, double z) {
    Gradient h;
    h << (g(r) + r * g1(r)) * std::cos(z), -r * g(r) * std::sin(z), g1(r) * std::sin(z), g(r) * std::cos(z),
        g(r) * std::cos(z);
    return h;
  }
  /// -div sigma, by hand.
  Eigen::Vector2d force(double r, double z) const {
    const double c = std::cos(z), s = std::sin(z);
    const double radial = lame * (4 * g1(r) + r * g2(r)) + 2 * shear * (2 * g1(r) + r * g2(r)) +
                          shear * (g1(r) - r * g(r)) + 2 * shear * g1(r);
    const double axial = shear * (g2(r) - g(r) - r * g1(r)) - lame * (3 * g(r) + r * g1(r)) - 2 * shear * g(r) +
                         shear * (-4 * (1 - r * r) - g(r));
    return {-radial * c, -axial * s};
  }
};

Eigen::Vector2d error_of(unsigned degree, Formulation formulation, double poisson, unsigned refinements) {
  const Material material{1, poisson};
  const Manufactured exact{material.shear(), material.lame()};
  const MeridianBody body(uniform_cylinder_mesh(1, 2, refinements), {degree, formulation}, {plate_side, true, true});
  DirectSolver solver;
  solver.factorise(body.stiffness(material));
  const Eigen::VectorXd lift = body.lifted(Manufactured::value);
  const Eigen::VectorXd load =
      body.body_force([&](double r, double z) { return exact.force(r, z); }) - body.internal_force(material, lift);
  const Eigen::VectorXd u = lift + body.distributed(solver.solve(body.condensed(load)));
  return body.error(u, Manufactured::value, Manufactured::gradient);
}

TEST(Elasticity, ManufacturedSolutionConvergesAtTheOrderOfTheElement) {
  for (const unsigned degree : {1u, 2u, 3u}) {
    for (const auto formulation : {Formulation::displacement, Formulation::projected}) {
      if (degree == 1 && formulation == Formulation::projected) {
        continue; // Q1 / P0 is not a stable pair; nothing is promised for it
      }
      const unsigned fine = degree == 1 ? 6 : degree == 2 ? 5 : 4;
      const Eigen::Vector2d order =
          (error_of(degree, formulation, 0.3, fine - 1).array() / error_of(degree, formulation, 0.3, fine).array())
              .log() /
          std::log(2.);
      const std::string what = fmt::format("manufactured, axisymmetric Q{}{}", degree,
                                           formulation == Formulation::projected ? " projected" : "");
      verify({what + ": order in L2", order[0], degree + 1., 0.1, "order p + 1", true});
      verify({what + ": order in H1", order[1], double(degree), 0.1, "order p", true});
    }
  }
}

/// Apparent modulus of a bonded cylinder h = R on n x n equal elements.
double coarse_modulus(unsigned degree, Formulation formulation, double poisson, unsigned refinements) {
  const Material material{1, poisson};
  const MeridianBody body(uniform_cylinder_mesh(1, 1, refinements), {degree, formulation}, {plate_side, true, true});
  DirectSolver solver;
  solver.factorise(body.stiffness(material));
  const Eigen::VectorXd lift = body.lifted([](double, double) { return Eigen::Vector2d(0, -0.5); });
  const Eigen::VectorXd u = lift + body.distributed(solver.solve(body.condensed(-body.internal_force(material, lift))));
  return -body.axial_force_on(plate_side, body.internal_force(material, u)) / std::numbers::pi;
}

TEST(Elasticity, ProjectedElementsDoNotLock) {
  for (const double nu : {0.4, 0.49, 0.499, 0.4999}) {
    // Reference: degree 4 on a fine mesh, where both forms agree.
    const double fine = coarse_modulus(4, Formulation::projected, nu, 4);
    const std::string where = fmt::format("bonded h = R, nu = {}, 4 x 4 elements: E_app, ", nu);
    report(where + "Q1 displacement", coarse_modulus(1, Formulation::displacement, nu, 2), fine, "Q4, 16 x 16");
    report(where + "Q2 displacement", coarse_modulus(2, Formulation::displacement, nu, 2), fine, "Q4, 16 x 16");
    verify({where + "Q2 projected", coarse_modulus(2, Formulation::projected, nu, 2), fine, 2e-2, "Q4, 16 x 16"});
  }
  const double q4 = coarse_modulus(4, Formulation::displacement, 0.499, 4);
  verify({"bonded h = R, nu = 0.499: Q4 displacement against Q4 projected", q4,
          coarse_modulus(4, Formulation::projected, 0.499, 4), 2e-3, "two forms of one problem"});
}

TEST(Elasticity, MaterialNamesWhatItRefuses) {
  EXPECT_THROW(check(Material{-1, 0.2}), std::invalid_argument);
  EXPECT_THROW(check(Material{1, -1}), std::invalid_argument);
  EXPECT_THROW(check(Material{1, 0.5}), std::invalid_argument);
  EXPECT_NO_THROW(check(Material{1, -0.9}));
  EXPECT_NO_THROW(check(Material{1, 0.4999}));
  EXPECT_THROW(MeridianBody(uniform_cylinder_mesh(1, 1, 1), {5, Formulation::automatic}), std::invalid_argument);
}

} // namespace
} // namespace boba::continuum::testing
