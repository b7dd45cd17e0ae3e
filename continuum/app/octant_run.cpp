// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/app/octant_run.h"

#include "continuum/app/report.h"

#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

namespace boba::continuum {
namespace {

using nlohmann::json;

template <class Problem> void check_octant(const Problem& problem) {
  check(problem);
  if (problem.finite_law || !problem.interface.rigid()) {
    throw std::invalid_argument("dimension = 3 is not allowed with finite kinematics or a compliant interface: use 2");
  }
  if (problem.material.poisson > 0.45) {
    throw std::invalid_argument(fmt::format("poisson = {} is not allowed with dimension = 3: it must lie in (-1, 0.45], "
                                            "beyond which the displacement form locks; use 2",
                                            problem.material.poisson));
  }
}

json common(const OctantSolution& solution) {
  return {{"force", solution.force},
          {"n_unknowns", solution.n_unknowns},
          {"cg_iterations", solution.iterations},
          {"active_set_iterations", solution.active_set_iterations},
          {"assemble_seconds", solution.assemble_seconds},
          {"precondition_seconds", solution.precondition_seconds},
          {"solve_seconds", solution.solve_seconds},
          {"seconds", solution.assemble_seconds + solution.precondition_seconds + solution.solve_seconds}};
}

} // namespace

json run_octant(const SphereProblem& problem, const OctantChoice& choice, json parameters) {
  check_octant(problem);
  json document = summary_header("sphere", std::move(parameters));
  for (const double approach : problem.approaches) {
    const Hertz guess = hertz(problem.radius, problem.material, approach / 2);
    SphereMeshSize size;
    size.lowest_edge = 0.9 * guess.contact_radius;
    size.highest_edge = std::min(1.1 * guess.contact_radius, 0.9 * problem.radius);
    size.elements_across = choice.elements_across;
    size.elements_inside = 0.6 * choice.elements_across;
    size.growth = 0.5;
    OctantShape shape;
    shape.radius = problem.radius;
    shape.refinements = choice.refinements;
    shape.wanted = [&](double x, double y, double z) {
      return wanted_size(std::hypot(x, y), z, 0, problem.radius, size);
    };
    OctantBody body(shape, choice.degree);
    const OctantSolution solution =
        body.press(problem.material, problem.radius - approach / 2, guess.contact_radius);
    json load = common(solution);
    load["approach"] = approach;
    load["contact_radius"] = solution.contact_radius;
    load["peak_pressure"] = load["central_pressure"] = solution.central_pressure;
    load["equatorial_bulge"] = solution.midheight_radial;
    load["hertz_force"] = guess.force;
    document["loads"].push_back(load);
    if (!choice.fields.empty()) {
      body.write(choice.fields);
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
  OctantBody body(shape, choice.degree);
  // Small strain: one solution, scaled.
  const OctantSolution unit = body.solve_held(problem.material, problem.height, problem.ends == Ends::bonded);
  for (const double strain : problem.strains) {
    json load = common(unit);
    load["strain"] = strain;
    load["force"] = strain * unit.force;
    load["apparent_modulus"] = unit.force / (std::numbers::pi * problem.radius * problem.radius);
    load["midheight_poisson"] = unit.midheight_radial / problem.radius;
    document["loads"].push_back(load);
  }
  if (!choice.fields.empty()) {
    body.write(choice.fields);
  }
  return document;
}

} // namespace boba::continuum
