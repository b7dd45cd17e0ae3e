// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/cylinder/cylinder.h"

#include "continuum/contact/finite_press.h"

#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

namespace boba::continuum {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void describe(CylinderLoad& load, const CylinderProblem& problem, const MeridianBody& body) {
  const double area = std::numbers::pi * problem.radius * problem.radius;
  load.profile = body.boundary_points(lateral, load.displacement);
  const double radial = load.profile.front().u_r / problem.radius;
  load.apparent_modulus = load.force / (area * load.strain);
  load.midheight_poisson = radial / load.strain;
  load.midheight_poisson_local = -radial / local_axial_strain(load.profile);
}

MeridianBody::Held held_ends(const CylinderProblem& problem) {
  if (problem.ends == Ends::bonded) {
    return {plate_side, true, true};
  }
  return {plate_side, false, problem.interface.rigid()};
}

/// Small strain, ends moved by prescribed displacements: one solution, scaled.
void solve_linear(const CylinderProblem& problem, CylinderResult& result) {
  const auto start = Clock::now();
  const MeridianBody& body = *result.body;
  DirectSolver solver;
  solver.factorise(body.stiffness(problem.material));
  const Eigen::VectorXd lift = body.lifted([&](double, double) { return Eigen::Vector2d(0, -problem.height / 2); });
  const Eigen::VectorXd pull = body.condensed(-body.internal_force(problem.material, lift));
  const Eigen::VectorXd unit = lift + body.distributed(solver.solve(pull));
  const double force = -body.axial_force_on(plate_side, body.internal_force(problem.material, unit));
  result.setup_seconds += seconds_since(start);
  for (const double strain : problem.strains) {
    const auto begin = Clock::now();
    CylinderLoad load;
    load.strain = strain;
    load.displacement = strain * unit;
    load.force = strain * force;
    describe(load, problem, body);
    load.seconds = seconds_since(begin);
    result.loads.push_back(std::move(load));
  }
}

/// Small strain, sliding ends behind a compliant layer.
void solve_layered(const CylinderProblem& problem, CylinderResult& result) {
  const auto start = Clock::now();
  PlatePress press(*result.body, problem.material, plate_side, problem.radius);
  result.setup_seconds += seconds_since(start);
  for (const double strain : problem.strains) {
    const auto begin = Clock::now();
    CylinderLoad load;
    load.strain = strain;
    const PressState state = press.press(problem.height / 2 * (1 - strain), problem.interface, most_active_sets);
    load.displacement = state.displacement;
    load.force = state.force;
    describe(load, problem, *result.body);
    load.seconds = seconds_since(begin);
    result.loads.push_back(std::move(load));
  }
}

/// Displacement of the small-strain problem for a unit strain: the guess from which Newton's method starts.
Eigen::VectorXd unit_displacement(const CylinderProblem& problem, const MeridianBody& body) {
  DirectSolver solver;
  solver.factorise(body.stiffness(problem.material));
  const Eigen::VectorXd lift = body.lifted([&](double, double) { return Eigen::Vector2d(0, -problem.height / 2); });
  return lift + body.distributed(solver.solve(body.condensed(-body.internal_force(problem.material, lift))));
}

/// Finite kinematics: each load starts from the last.
void solve_finite(const CylinderProblem& problem, CylinderResult& result) {
  const MeridianBody& body = *result.body;
  const bool layered = !problem.interface.rigid();
  FinitePress press = layered ? FinitePress(body, *problem.finite_law, plate_side, problem.radius)
                              : FinitePress(body, *problem.finite_law);
  const Eigen::VectorXd unit = layered ? Eigen::VectorXd() : unit_displacement(problem, body);
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(body.n_unknowns());
  double reached = 0;
  for (const double strain : problem.strains) {
    const auto begin = Clock::now();
    CylinderLoad load;
    load.strain = strain;
    const double half = problem.height / 2;
    const PressState state = layered ? press.press(half * (1 - reached), half * (1 - strain), problem.interface)
                                     : press.move(displacement + (strain - reached) * unit);
    displacement = load.displacement = state.displacement;
    reached = strain;
    load.force = layered ? state.force
                         : -body.axial_force_on(plate_side, body.internal_force(*problem.finite_law, displacement));
    load.newton_iterations = state.newton_iterations;
    load.ellipticity = check_ellipticity(body, *problem.finite_law, displacement) / problem.material.shear();
    describe(load, problem, body);
    load.seconds = seconds_since(begin);
    result.loads.push_back(std::move(load));
  }
}

} // namespace

double local_axial_strain(const std::vector<FieldPoint>& side) {
  // u_z is odd in z: the slope at 0 from two values, to fourth order.
  const FieldPoint& a = side.at(1);
  if (side.size() < 4) {
    return a.u_z / a.z;
  }
  const FieldPoint& b = side.at(2);
  const double sa = a.u_z / a.z, sb = b.u_z / b.z;
  return (sa * b.z * b.z - sb * a.z * a.z) / (b.z * b.z - a.z * a.z);
}

void check(const CylinderProblem& problem) {
  check(static_cast<const CompressedBody&>(problem));
  check_positive("height", problem.height);
  if (problem.strains.empty()) {
    throw std::invalid_argument("strain = (none) is not allowed: give at least one nominal strain in (-1, 1)");
  }
  for (const double strain : problem.strains) {
    if (!(std::abs(strain) < 1) || strain == 0) {
      throw std::invalid_argument(
          fmt::format("strain = {} is not allowed: it must lie in (-1, 1) and not be 0", strain));
    }
    if (!problem.interface.rigid() && strain < 0) {
      throw std::invalid_argument(
          fmt::format("strain = {} is not allowed with a compliant interface: it must be > 0", strain));
    }
  }
  if (!problem.interface.rigid() && problem.ends == Ends::bonded) {
    throw std::invalid_argument("interface = compliant is not allowed with bonded ends: it needs sliding ends");
  }
}

CylinderResult solve(const CylinderProblem& problem) {
  check(problem);
  CylinderResult result;
  const auto start = Clock::now();
  result.body = std::make_shared<MeridianBody>(cylinder_mesh(problem.radius, problem.height, problem.mesh),
                                               problem.discretisation, held_ends(problem));
  result.setup_seconds = seconds_since(start);
  if (problem.finite_law) {
    solve_finite(problem, result);
  } else if (problem.interface.rigid()) {
    solve_linear(problem, result);
  } else {
    solve_layered(problem, result);
  }
  return result;
}

} // namespace boba::continuum
