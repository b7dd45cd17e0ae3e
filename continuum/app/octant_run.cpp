// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/app/octant_run.h"

#include "continuum/app/report.h"

#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

namespace boba::continuum {
namespace {

using nlohmann::json;

/// Iterations grow like the square root of the volume modulus over mu: this is as far as they stay below 1000.
constexpr double largest_poisson = 0.499;

template <class Problem> void check_octant(const Problem& problem) {
  check(problem);
  if (problem.finite_law || !problem.interface.rigid()) {
    throw std::invalid_argument("dimension = 3 is not allowed with finite kinematics or a compliant interface: use 2");
  }
  if (problem.material.poisson > largest_poisson) {
    throw std::invalid_argument(fmt::format("poisson = {} is not allowed with dimension = 3: it must lie in (-1, {}], "
                                            "beyond which the iterations grow too many; use dimension = 2",
                                            problem.material.poisson, largest_poisson));
  }
}

json common(const OctantSolution& solution) {
  return {{"force", solution.force},
          {"n_unknowns", solution.n_unknowns},
          {"cg_iterations", solution.iterations},
          {"active_set_iterations", solution.active_set_iterations},
          {"assemble_seconds", solution.assemble.wall},
          {"precondition_seconds", solution.precondition.wall},
          {"solve_seconds", solution.solve.wall},
          {"assemble_cpu_seconds", solution.assemble.cpu},
          {"precondition_cpu_seconds", solution.precondition.cpu},
          {"solve_cpu_seconds", solution.solve.cpu},
          {"seconds", solution.assemble.wall + solution.precondition.wall + solution.solve.wall}};
}

std::vector<FieldPoint> scaled(std::vector<FieldPoint> points, double factor) {
  for (auto& point : points) {
    point.u_r *= factor;
    point.u_z *= factor;
  }
  return points;
}

} // namespace

json run_octant(const SphereProblem& problem, const OctantChoice& choice, json parameters) {
  check_octant(problem);
  json document = summary_header("sphere", std::move(parameters));
  unsigned number = 0;
  for (const double approach : problem.approaches) {
    const Hertz guess = hertz(problem.radius, problem.material, approach / 2);
    OctantShape shape =
        graded_sphere(problem.radius, 0.9 * guess.contact_radius,
                      std::min(1.1 * guess.contact_radius, 0.9 * problem.radius), choice.elements_across);
    shape.refinements = choice.refinements;
    OctantBody body(shape, problem.discretisation, choice.multigrid);
    const OctantSolution solution =
        body.press(problem.material, problem.radius - approach / 2, guess.contact_radius, problem.max_active_sets);
    json load = common(solution);
    load["approach"] = approach;
    load["contact_radius"] = solution.contact_radius;
    load["peak_pressure"] = load["central_pressure"] = solution.central_pressure;
    load["equatorial_bulge"] = solution.profile.front().u_r;
    load["hertz_force"] = guess.force;
    load["hertz_contact_radius"] = guess.contact_radius;
    load["hertz_peak_pressure"] = guess.peak_pressure;
    load["contact"] = {{"r", array_of(solution.r)}, {"pressure", array_of(solution.pressure)}};
    load["profile"] = profile_of(solution.profile);
    document["loads"].push_back(load);
    if (!choice.fields.empty()) {
      body.write(choice.fields, number++);
    }
  }
  return document;
}

json run_octant(const CylinderProblem& problem, const OctantChoice& choice, json parameters) {
  check_octant(problem);
  json document = summary_header("cylinder", std::move(parameters));
  OctantShape shape;
  shape.radius = problem.radius;
  shape.height = problem.height;
  shape.refinements = choice.refinements;
  OctantBody body(shape, problem.discretisation, choice.multigrid);
  // Small strain: one solution, that of the last load, scaled.
  const double last = problem.strains.back();
  const OctantSolution solution =
      body.solve_held(problem.material, last * problem.height, problem.ends == Ends::bonded);
  const double radial = solution.profile.front().u_r / problem.radius;
  for (const double strain : problem.strains) {
    json load = common(solution);
    load["strain"] = strain;
    load["profile"] = profile_of(scaled(solution.profile, strain / last));
    load["force"] = strain / last * solution.force;
    load["apparent_modulus"] = solution.force / (last * std::numbers::pi * problem.radius * problem.radius);
    load["midheight_poisson"] = radial / last;
    load["midheight_poisson_local"] = -radial / local_axial_strain(solution.profile);
    document["loads"].push_back(load);
  }
  if (!choice.fields.empty()) {
    body.write(choice.fields, unsigned(problem.strains.size() - 1));
  }
  return document;
}

} // namespace boba::continuum
