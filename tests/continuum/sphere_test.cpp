// SPDX-License-Identifier: GPL-3.0-or-later
// The compressed sphere against the exact linear solution, Hertz, and published numbers.
#include "continuum/sphere/sphere.h"
#include "legendre_sphere.h"
#include "verification_row.h"

#include <map>
#include <utility>
#include <vector>

namespace boba::continuum::testing {
namespace {

const std::vector<double> poissons = {-0.5, 0, 0.25, 0.4, 0.49};
const std::vector<double> edges = {0.01, 0.03, 0.1, 0.3};

SphereLoad one_load(double poisson, double approach_of_one_plate, double elements_across = 48) {
  SphereProblem problem;
  problem.material = {1, poisson};
  problem.approaches = {2 * approach_of_one_plate};
  problem.elements_across = elements_across;
  return solve(problem).front();
}

TEST(Sphere, MatchesTheLegendreSeries) {
  for (const double nu : poissons) {
    for (const double a : edges) {
      const LegendreSphere exact = legendre_sphere(nu, a);
      const SphereLoad load = one_load(nu, exact.approach);
      const std::string where = fmt::format("nu = {}, a/R = {}", nu, a);
      const std::string source = "Legendre series (Lur'e 1964), summed in the test";
      verify({"sphere F, " + where, load.force, exact.force, 1e-3, source});
      verify({"sphere a, " + where, load.contact_radius, a, 5e-3, source});
      verify({"sphere p0, " + where, load.central_pressure, exact.central_pressure, 5e-3, source});
    }
  }
}

TEST(Sphere, TheSeriesConverges) {
  const LegendreSphere best = legendre_sphere(0.25, 0.1, {3200, 8});
  double error[3];
  for (int k = 0; k < 3; ++k) {
    const LegendreSphere now = legendre_sphere(0.25, 0.1, {100. * (1 << k), 5});
    error[k] = std::abs(now.force / best.force - 1) + std::abs(now.approach / best.approach - 1);
    report(fmt::format("series: F, harmonics to {} R/a, 5 terms", 100 << k), now.force, best.force,
           "series to 3200 R/a, 8 terms");
    report(fmt::format("series: approach, harmonics to {} R/a, 5 terms", 100 << k), now.approach, best.approach,
           "series to 3200 R/a, 8 terms");
  }
  EXPECT_LT(error[1], error[0] / 4);
  EXPECT_LT(std::abs(legendre_sphere(0.25, 0.1).force / best.force - 1), 1e-5);
  // Hertz is its limit of small contacts.
  const LegendreSphere small = legendre_sphere(0.25, 1e-3);
  verify({"series against Hertz, nu = 0.25, a/R = 0.001", small.force, hertz(1, {1, 0.25}, small.approach).force, 1e-3,
          "Johnson 1985, eq. (4.23)"});
}

TEST(Sphere, MatchesHertzWhereHertzHolds) {
  for (const double nu : {0.25, 0.4, 0.49}) {
    const SphereLoad load = one_load(nu, 1e-4);
    verify({fmt::format("sphere F against Hertz, nu = {}, a/R = 0.01", nu), load.force, load.hertz.force, 5e-3,
            "Johnson 1985, eq. (4.23)"});
  }
}

TEST(Sphere, ReproducesTheTableOfDeparturesFromHertz) {
  // F / F_Hertz at equal approach for a contact of radius a: an earlier calculation by two methods.
  const std::map<double, std::vector<double>> table = {{-0.5, {0.965, 0.927, 0.868, 0.885}},
                                                       {0, {0, 0.996, 1.022, 1.168}},
                                                       {0.25, {1.003, 1.013, 1.054, 1.201}},
                                                       {0.4, {0, 1.015, 1.053, 1.168}},
                                                       {0.49, {1.004, 1.012, 1.040, 1.121}}};
  for (const auto& [nu, row] : table) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const LegendreSphere exact = legendre_sphere(nu, edges[i]);
      const SphereLoad load = one_load(nu, exact.approach);
      const std::string what = fmt::format("F/F_Hertz, nu = {}, a/R = {}", nu, edges[i]);
      const double ratio = load.force / load.hertz.force;
      if (row[i] > 0) {
        verify({what, ratio, row[i], 5e-3, "earlier calculation by two methods, three digits"});
      } else {
        verify({what, ratio, exact.force / load.hertz.force, 1e-3, "Legendre series"});
      }
    }
  }
}

TEST(Sphere, ReportsTheFarFieldRelation) {
  for (const double nu : poissons) {
    for (const double a : edges) {
      const LegendreSphere exact = legendre_sphere(nu, a);
      report(fmt::format("approach by Tatara's relation, nu = {}, a/R = {}", nu, a),
             tatara_approach(1, {1, nu}, exact.force, a), exact.approach, "Tatara 1991; reference: Legendre series");
    }
  }
}

TEST(Sphere, TwoSpheresOfCodeAster) {
  SphereProblem problem;
  problem.radius = 50;
  problem.material = {20000, 0.3};
  problem.approaches = {4};
  const SphereLoad load = solve(problem).front();
  const std::string source = "code_aster SSNV104 (Hertz)";
  report("two spheres R = 50, E = 20000, nu = 0.3, approach 4: a", load.contact_radius, 10, source);
  report("two spheres: p0", load.central_pressure, 2798.3, source);
  // The sphere at a/R = 0.2 is no longer Hertz's half space: the exact linear solution at the same approach.
  double low = 0.15, high = 0.25;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    (legendre_sphere(0.3, middle).approach * 50 < 2 ? low : high) = middle;
  }
  const LegendreSphere exact = legendre_sphere(0.3, low);
  verify({"two spheres: a against the series", load.contact_radius, 50 * low, 5e-3, "Legendre series"});
  verify({"two spheres: p0 against the series", load.central_pressure, 20000 * exact.central_pressure, 5e-3,
          "Legendre series"});
}

TEST(Sphere, LoadsThatShareAMeshAgreeWithSingleOnes) {
  SphereProblem problem;
  problem.material = {1, 0.4};
  problem.approaches = {2e-3, 4e-3, 6e-3, 1e-2, 2e-2};
  const auto together = solve(problem);
  EXPECT_EQ(together[0].body, together[1].body);
  for (const auto& load : together) {
    EXPECT_NEAR(load.force / one_load(0.4, load.approach / 2).force, 1, 2e-4);
  }
}

TEST(Sphere, CompliantLayerTendsToTheRigidPlateAtFirstOrder) {
  SphereProblem problem;
  problem.material = {1, -0.25};
  problem.approaches = {0.02};
  const double rigid = solve(problem).front().force;
  std::vector<double> difference;
  for (const double c1 : {100., 200., 400., 800.}) {
    problem.interface = {c1, 0};
    difference.push_back(1 - solve(problem).front().force / rigid);
    report(fmt::format("sphere on a layer c1 = {} E/R: F", c1), (1 - difference.back()) * rigid, rigid, "rigid plate");
  }
  for (std::size_t k = 1; k < difference.size(); ++k) {
    EXPECT_GT(difference[k], 0);
    const double order = std::log2(difference[k - 1] / difference[k]);
    verify({fmt::format("order in 1/c1, c1 = {}", 100 << k), order, 1, 0.1, "first order", true});
  }
}

TEST(Sphere, RefusesWhatCannotBePosed) {
  const auto message = [](auto change) -> std::string {
    SphereProblem problem;
    problem.approaches = {0.01};
    change(problem);
    try {
      solve(problem);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message([](auto& p) { p.radius = -1; }).find("radius = -1"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.material.young = 0; }).find("young = 0"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.material.poisson = 0.5; }).find("(-1, 0.5)"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.approaches = {2}; }).find("plates cross"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.elements_across = 7; }).find("[8, 4096]"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.discretisation.degree = 9; }).find("degree = 9"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.interface = {-1, 0}; }).find("c1 = -1"), std::string::npos);
}

} // namespace
} // namespace boba::continuum::testing
