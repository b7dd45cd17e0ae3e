// SPDX-License-Identifier: GPL-3.0-or-later
// Prints, as CSV, run time (start-up apart) against the error of the force for sphere and cylinder.
#include "continuum/cylinder/cylinder.h"
#include "continuum/sphere/sphere.h"
#include "legendre_sphere.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>

namespace {

using namespace boba::continuum;
using Clock = std::chrono::steady_clock;

/// Shortest time of three runs of work(), in seconds: the machine may be shared.
template <class Work> double timed(Work&& work) {
  double best = 1e300;
  for (int repeat = 0; repeat < 3; ++repeat) {
    const auto start = Clock::now();
    work();
    best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return best;
}

void sphere(double poisson, double edge) {
  const auto exact = testing::legendre_sphere(poisson, edge, {1600, 6});
  for (const unsigned degree : {1u, 2u, 3u}) {
    for (const double across : {8., 16., 32., 64., 128., 256.}) {
      SphereProblem problem;
      problem.material = {1, poisson};
      problem.approaches = {2 * exact.approach};
      problem.elements_across = across;
      problem.discretisation.degree = degree;
      std::vector<SphereLoad> loads;
      const double seconds = timed([&] { loads = solve(problem); });
      const auto& load = loads.front();
      fmt::print("sphere nu={} a/R={},Q{},{},{},{:.3e},{:.3e},{:.3e},{:.4f}\n", poisson, edge, degree, across,
                 load.n_unknowns, std::abs(load.force / exact.force - 1), std::abs(load.contact_radius / edge - 1),
                 std::abs(load.central_pressure / exact.central_pressure - 1), seconds);
    }
  }
}

void load_curve() {
  SphereProblem problem;
  problem.material = {1, 0.25};
  for (int k = 1; k <= 20; ++k) {
    problem.approaches.push_back(0.004 * k);
  }
  std::vector<SphereLoad> loads;
  const double seconds = timed([&] { loads = solve(problem); });
  fmt::print("sphere 20 loads to approach 0.08 (per load),Q2,48,{},,,,{:.4f}\n", loads.back().n_unknowns, seconds / 20);
}

void cylinder(double poisson) {
  const auto modulus = [&](unsigned degree, const CylinderMeshSize& mesh, int* unknowns) {
    CylinderProblem problem;
    problem.radius = 7;
    problem.height = 20;
    problem.material = {1, poisson};
    problem.discretisation.degree = degree;
    problem.mesh = mesh;
    const auto result = solve(problem);
    *unknowns = result.body->n_unknowns();
    return result.loads.front().apparent_modulus;
  };
  int unknowns = 0;
  const double exact = modulus(4, {1e-7, 0.15, 0.1}, &unknowns);
  for (const unsigned degree : {1u, 2u, 3u}) {
    for (const double corner : {1e-1, 1e-2, 1e-3, 1e-4}) {
      const CylinderMeshSize mesh{corner, 0.35, degree == 1 ? 0.1 : 0.2};
      double value = 0;
      const double seconds = timed([&] { value = modulus(degree, mesh, &unknowns); });
      fmt::print("bonded cylinder R=7 h=20 nu={},Q{},{},{},{:.3e},,,{:.4f}\n", poisson, degree, corner, unknowns,
                 std::abs(value / exact - 1), seconds);
    }
  }
}

} // namespace

int main() {
  fmt::print("problem,element,size,unknowns,error_force,error_radius,error_pressure,seconds\n");
  sphere(0.25, 0.1);
  sphere(-0.5, 0.3);
  sphere(0.49, 0.01);
  load_curve();
  cylinder(0.4);
  cylinder(-0.5);
}
