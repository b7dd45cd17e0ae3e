// SPDX-License-Identifier: GPL-3.0-or-later
// Finite kinematics: laws against closed forms, bodies against the laws, and the limit of small strain.
#include "continuum/cylinder/cylinder.h"
#include "continuum/sphere/sphere.h"
#include "tests/support/temporary_folder.h"
#include "verification_row.h"

#include <numbers>

namespace boba::continuum::testing {
namespace {

Gradient gradient_of(double a, double b, double c, double d, double e) {
  Gradient h;
  h << a, b, c, d, e;
  return h;
}

std::vector<std::shared_ptr<HyperelasticLaw>> laws() {
  return {std::make_shared<NeoHookean>(Material{2, 0.3}), std::make_shared<NeoHookean>(Material{2, -0.4}),
          std::make_shared<Foam>(std::vector<FoamTerm>{{0.8, 3, -0.2}, {0.3, -5, 0.3}})};
}

TEST(Hyperelastic, TangentIsTheDerivativeOfTheStress) {
  for (const auto& law : laws()) {
    // The second state has two equal stretches in the plane, the third none.
    for (const Gradient& h : {gradient_of(0.1, 0.2, -0.15, -0.3, 0.05), gradient_of(0.1, 0, 0, 0.1, -0.2),
                              gradient_of(-0.2, 0.3, 0.1, 0.4, 0)}) {
      const GradientResponse here = law->at(h);
      for (int k = 0; k < 5; ++k) {
        Gradient up = h, down = h;
        up[k] += 1e-5;
        down[k] -= 1e-5;
        const Gradient slope = (law->at(up).stress - law->at(down).stress) / 2e-5;
        EXPECT_LT((slope - here.tangent.col(k)).norm(), 1e-7 * here.tangent.norm());
      }
      EXPECT_LT((here.tangent - here.tangent.transpose()).norm(), 1e-12 * here.tangent.norm());
    }
  }
  EXPECT_THROW(laws()[0]->at(gradient_of(-1.1, 0, 0, 0, 0)), Inverted);
}

TEST(Hyperelastic, SmallStrainIsLinearElasticity) {
  const Material material{2, -0.4};
  const LinearLaw linear(material.shear(), material.lame());
  const Foam foam({{material.shear(), 4, material.poisson}});
  const Gradient zero = Gradient::Zero();
  EXPECT_LT((NeoHookean(material).at(zero).tangent - linear.at(zero).tangent).norm(), 1e-12);
  EXPECT_LT((foam.at(zero).tangent - linear.at(zero).tangent).norm(), 1e-12);
  // Waves in an elastic solid: mu is the lower modulus when lambda + mu > 0.
  // (the eigenvalues are computed in closed form, which keeps half of the digits).
  EXPECT_NEAR(NeoHookean(material).lowest_acoustic(zero), material.shear(), 1e-7);
}

TEST(Hyperelastic, FoamKeepsItsLogarithmicPoissonRatio) {
  for (const double nu : {-0.4, 0., 0.3}) {
    const Foam foam({{0.7, 5, nu}});
    const UniaxialState state = uniaxial(foam, 0.8);
    verify({fmt::format("foam, nu = {}: stretch across at 0.8", nu), state.lateral_stretch, std::pow(0.8, -nu), 1e-12,
            "l^-nu (Storakers 1986)"});
    const double volume = 0.8 * state.lateral_stretch * state.lateral_stretch;
    const double stress = 2 * 0.7 / 5 / 0.8 * (std::pow(0.8, 5) - std::pow(volume, -5 * nu / (1 - 2 * nu)));
    verify({fmt::format("foam, nu = {}: stress at 0.8", nu), state.stress, stress, 1e-12, "closed form"});
  }
}

TEST(Hyperelastic, NeoHookeanWithNegativeLambdaLosesEllipticityWhenStretched) {
  // Along the axis d2W/dl^2 = mu + (mu + lambda - lambda ln J) / l^2: with lambda = -0.64 mu it is negative when the
  // body is stretched to l = 1.5 and its volume shrinks to J = 0.005.
  const Material auxetic{1, -0.9};
  const NeoHookean law(auxetic);
  EXPECT_GT(law.lowest_acoustic(Gradient::Zero()), 0);
  const double l = 1.5, volume = 0.005, across = std::sqrt(volume / l);
  const double axial =
      auxetic.shear() + (auxetic.shear() + auxetic.lame() - auxetic.lame() * std::log(volume)) / (l * l);
  ASSERT_LT(axial, 0);
  EXPECT_LE(law.lowest_acoustic(gradient_of(across - 1, 0, 0, l - 1, across - 1)), axial + 1e-6);
}

TEST(Hyperelastic, FitFindsTheFoamThatMadeTheCurve) {
  const Foam truth({{0.5, 2.5, 0.1}, {0.2, -6, -0.4}});
  std::vector<UniaxialState> states;
  for (int k = 1; k <= 20; ++k) {
    states.push_back(uniaxial(truth, 1 - 0.015 * k));
  }
  const double slope = states[0].stress / -0.015;
  const Foam found(fitted_foam(states, {std::abs(slope), -0.05}, 2));
  for (const double stretch : {0.95, 0.85, 0.72}) {
    const UniaxialState a = uniaxial(found, stretch), b = uniaxial(truth, stretch);
    EXPECT_NEAR(a.stress / b.stress, 1, 2e-3);
    // The Poisson ratio to 1e-3.
    EXPECT_NEAR(a.lateral_stretch, b.lateral_stretch, 1e-3 * (1 - stretch));
  }
  EXPECT_THROW(fitted_foam({}, {1, 0}, 1), std::invalid_argument);
}

TEST(FiniteCylinder, SlidingEndsFollowTheUniaxialLaw) {
  for (const auto& law : laws()) {
    CylinderProblem problem;
    problem.radius = 0.7;
    problem.material = {2, 0.3};
    problem.ends = Ends::sliding;
    problem.finite_law = law;
    problem.strains = {0.1, 0.3, -0.2};
    problem.mesh.corner = 0.1;
    for (const auto& load : solve(problem).loads) {
      const UniaxialState state = uniaxial(*law, 1 - load.strain);
      verify({fmt::format("finite sliding cylinder, strain {}: nominal stress", load.strain),
              load.force / (std::numbers::pi * 0.49), -state.stress, 1e-9, "uniaxial stress of the law"});
      verify({fmt::format("finite sliding cylinder, strain {}: radial stretch", load.strain),
              1 + load.profile.front().u_r / 0.7, state.lateral_stretch, 1e-9, "uniaxial stress of the law"});
    }
  }
}

TEST(FiniteCylinder, StopsAtTheLimitStrainOfTheLawAndSaysSo) {
  // Free sides: with x = (lateral stretch)^2 and nu = -0.5 the law's side is in equilibrium where x - (ln x)/2 = 1 +
  // (ln l)/2. The left side is lowest, 1/2 + (ln 2)/2, at x = 1/2: no state is shorter than l = exp(ln 2 - 1).
  const double limit = 1 - 2 / std::numbers::e;
  CylinderProblem problem;
  problem.height = 1;
  problem.material = {1, -0.5};
  problem.ends = Ends::sliding;
  problem.finite_law = std::make_shared<NeoHookean>(problem.material);
  problem.mesh.corner = 0.2;
  problem.strains = {0.15, 0.25, limit - 1e-3};
  EXPECT_EQ(solve(problem).loads.size(), 3U);
  problem.strains.back() = limit + 1e-3;
  const std::string message = boba::test::message_of<NotSettled>([&] { solve(problem); });
  EXPECT_NE(message.find("limit load"), std::string::npos) << message;
}

TEST(FiniteCylinder, TendsToTheLinearOneAtFirstOrder) {
  for (const double nu : {-0.5, 0.4}) {
    CylinderProblem problem;
    problem.radius = 7;
    problem.height = 20;
    problem.material = {1, nu};
    problem.mesh.corner = 0.02;
    problem.strains = {0.01, 0.02, 0.04};
    const double linear = solve(problem).loads[0].apparent_modulus;
    problem.finite_law = std::make_shared<NeoHookean>(problem.material);
    const auto loads = solve(problem).loads;
    for (int k = 1; k < 3; ++k) {
      const double order = std::log2((loads[std::size_t(k)].apparent_modulus / linear - 1) /
                                     (loads[std::size_t(k) - 1].apparent_modulus / linear - 1));
      verify({fmt::format("finite against linear bonded cylinder, nu = {}, strain {}: order", nu,
                          loads[std::size_t(k)].strain),
              order, 1, 0.15, "first order", true});
    }
  }
}

TEST(FiniteSphere, PassesTheLoadAtWhichThePlateAloneHoldsTheAuxeticBody) {
  // Beyond an approach of 0.29 the body is unstable under its pressures; with the plate's constraint it is not.
  SphereProblem problem;
  problem.material = {1, -0.5};
  problem.finite_law = std::make_shared<NeoHookean>(problem.material);
  problem.elements_across = 16;
  problem.approaches = {0.1, 0.25, 0.32};
  const SphereLoad load = solve(problem).back();
  EXPECT_GE(load.pressure.minCoeff(), 0);
  EXPECT_LT(load.overlap.maxCoeff(), 1e-10);
  EXPECT_LT(load.pressure.cwiseProduct(load.overlap).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_GT(load.ellipticity, 0);
  // The law itself loses ellipticity below the plate's centre at about 0.4.
  problem.approaches = {0.1, 0.25, 0.32, 0.42};
  const std::string message = boba::test::message_of<NotSettled>([&] { solve(problem); });
  EXPECT_NE(message.find("loses ellipticity"), std::string::npos) << message;
}

TEST(FiniteSphere, TendsToTheLinearOneAtFirstOrder) {
  for (const double nu : {-0.5, 0.25}) {
    SphereProblem problem;
    problem.material = {1, nu};
    problem.approaches = {0.0005, 0.001, 0.002};
    const auto linear = solve(problem);
    problem.finite_law = std::make_shared<NeoHookean>(problem.material);
    const auto finite = solve(problem);
    double difference[3];
    for (std::size_t k = 0; k < 3; ++k) {
      difference[k] = std::abs(finite[k].force / linear[k].force - 1);
      report(fmt::format("finite against linear sphere, nu = {}, approach {}: F", nu, linear[k].approach),
             finite[k].force, linear[k].force, "small strain");
    }
    // The strain in the contact goes like a / R, the square root of the approach.
    for (std::size_t k = 1; k < 3; ++k) {
      verify({fmt::format("finite against linear sphere, nu = {}, approach {}: order in a/R", nu, linear[k].approach),
              2 * std::log2(difference[k] / difference[k - 1]), 1, 0.25, "first order", true});
    }
  }
}

} // namespace
} // namespace boba::continuum::testing
