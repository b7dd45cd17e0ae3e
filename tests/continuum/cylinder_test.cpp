// SPDX-License-Identifier: GPL-3.0-or-later
// The compressed cylinder: exact states, limits, and its own convergence.
#include "continuum/cylinder/cylinder.h"
#include "verification_row.h"

#include <numbers>

namespace boba::continuum::testing {
namespace {

CylinderResult bonded(double radius, double height, double poisson, CylinderMeshSize mesh = {}) {
  CylinderProblem problem;
  problem.radius = radius;
  problem.height = height;
  problem.material = {1, poisson};
  problem.mesh = mesh;
  return solve(problem);
}

TEST(Cylinder, SlidingEndsAreUniaxialStress) {
  for (const double nu : {-0.5, 0., 0.25, 0.4, 0.49}) {
    CylinderProblem problem;
    problem.radius = 0.7;
    problem.height = 2;
    problem.material = {3, nu};
    problem.ends = Ends::sliding;
    problem.strains = {0.02};
    const auto result = solve(problem);
    const auto& load = result.loads.front();
    verify({fmt::format("sliding cylinder, nu = {}: stress", nu), load.force / (std::numbers::pi * 0.49), 0.06, 1e-9,
            "E eps"});
    double worst = 0, worst_stress = 0;
    for (const auto& point : load.profile) {
      worst = std::max(worst, std::abs(point.u_r - nu * 0.02 * 0.7) + std::abs(point.u_z + 0.02 * point.z));
    }
    for (const auto& s : result.body->stress(problem.material, load.displacement)) {
      worst_stress = std::max(worst_stress, std::abs(s.zz + 0.06) + std::abs(s.rr) + std::abs(s.hoop) + std::abs(s.rz));
    }
    verify({fmt::format("sliding cylinder, nu = {}: side, largest error", nu), worst, 0, 1e-9, "u_r = nu eps R", true});
    verify({fmt::format("sliding cylinder, nu = {}: stress field, largest error", nu), worst_stress, 0, 1e-9,
            "uniaxial stress", true});
    if (nu != 0) {
      verify(
          {fmt::format("sliding cylinder, nu = {}: Poisson ratio", nu), load.midheight_poisson_local, nu, 1e-9, "nu"});
    }
  }
}

TEST(Cylinder, LayerInSeriesWithASlidingCylinder) {
  CylinderProblem problem;
  problem.radius = 1;
  problem.height = 3;
  problem.material = {2, 0.3};
  problem.ends = Ends::sliding;
  problem.interface = {5, 0};
  problem.strains = {0.01, 0.02};
  for (const auto& load : solve(problem).loads) {
    // Half a cylinder of height 1.5 and one layer share half the approach.
    const double p = load.strain * 1.5 / (1.5 / 2 + 1 / 5.);
    verify({fmt::format("cylinder and layer in series, strain {}: p", load.strain), load.force / std::numbers::pi, p,
            1e-9, "delta = p (h/E + 1/c1)"});
  }
  problem.interface = {5, 4e4};
  problem.strains = {0.02};
  const double p = solve(problem).loads.front().force / std::numbers::pi;
  const double g = 0.03 - p * 1.5 / 2;
  verify({"cylinder and cubic layer in series: p", p, 5 * g + 4e4 * g * g * g, 1e-9, "p = c1 g + c3 g^3"});
}

TEST(Cylinder, BondedEndsWithoutPoissonEffect) {
  for (const double height : {0.1, 1., 20.}) {
    verify({fmt::format("bonded cylinder, nu = 0, h/R = {}: E_app/E", height),
            bonded(1, height, 0).loads.front().apparent_modulus, 1, 1e-3, "exact"});
  }
}

TEST(Cylinder, BondedDiscTendsToUniaxialStrain) {
  for (const double nu : {-0.5, 0.25, 0.4, 0.49}) {
    const double limit = Material{1, nu}.uniaxial_strain();
    // The free side costs a rim of the width of the height: its share falls like h/R and is extrapolated away.
    const double at = bonded(1000, 1, nu).loads.front().apparent_modulus;
    const double twice = bonded(2000, 1, nu).loads.front().apparent_modulus;
    report(fmt::format("bonded disc R/h = 2000, nu = {}: E_app/E", nu), twice, limit, "uniaxial strain");
    verify({fmt::format("bonded disc R/h -> infinity, nu = {}: E_app/E", nu), 2 * twice - at, limit, 1e-3,
            "Gent and Lindley 1959 limit E(1-nu)/((1+nu)(1-2nu))"});
  }
}

TEST(Cylinder, BondedSpecimenConverges) {
  for (const double nu : {-0.5, 0.25, 0.4, 0.49}) {
    double value[3];
    for (int k = 0; k < 3; ++k) {
      value[k] =
          bonded(7, 20, nu, {1e-2 / std::pow(8, k), 0.4 / (1 << k), 0.25 / (1 << k)}).loads.front().apparent_modulus;
    }
    const double first = value[1] - value[0], second = value[2] - value[1];
    const double limit = std::abs(first) > 1e-12 ? value[2] + second * second / (first - second) : value[2];
    verify({fmt::format("bonded cylinder R = 7, h = 20, nu = {}: E_app/E", nu),
            bonded(7, 20, nu).loads.front().apparent_modulus, limit, 1e-3, "own value, Richardson-extrapolated"});
  }
}

TEST(Cylinder, ForceIsTheWorkOfTheStresses) {
  const auto result = bonded(1, 2, 0.4);
  const auto& load = result.loads.front();
  // Equilibrium: the axial stress integrates to the same force through every cross-section; here over the volume.
  double sum = 0, volume = 0;
  for (const auto& s : result.body->stress({1, 0.4}, load.displacement)) {
    sum -= s.zz * s.weight;
    volume += s.weight;
  }
  verify({"bonded cylinder: force against the mean axial stress", load.force, sum / volume * std::numbers::pi, 1e-3,
          "equilibrium of a section"});
}

TEST(Cylinder, RefusesWhatCannotBePosed) {
  const auto refused = [](auto change) {
    CylinderProblem problem;
    change(problem);
    EXPECT_THROW(solve(problem), std::invalid_argument);
  };
  refused([](auto& p) { p.height = 0; });
  refused([](auto& p) { p.strains = {1.2}; });
  refused([](auto& p) { p.strains = {}; });
  refused([](auto& p) { p.material.poisson = -1; });
  refused([](auto& p) { p.interface = {1, 0}; });
}

} // namespace
} // namespace boba::continuum::testing
