// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/contact/finite_press.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace boba::continuum {
namespace {

constexpr int max_newton = 25;
constexpr int max_held_rounds = 30;
/// Shares of a Newton step and of a load below which the search ends.
constexpr double shortest_step = 1. / 64;
constexpr double shortest_load = 1. / 256;
constexpr double tolerance = 1e-9;

PressState between(const PressState& from, const PressState& to, double share) {
  PressState state = to;
  state.displacement = from.displacement + share * (to.displacement - from.displacement);
  state.pressure = from.pressure + share * (to.pressure - from.pressure);
  return state;
}

/// Nodal forces of unit pressures at the active vertices.
SparseMatrix columns_of(const ContactSurface& surface, const std::vector<bool>& active) {
  const auto held = active_nodes(active);
  SparseMatrix result(surface.loads().rows(), Eigen::Index(held.size()));
  for (std::size_t k = 0; k < held.size(); ++k) {
    result.col(Eigen::Index(k)) = surface.loads().col(held[k]);
  }
  return result;
}

} // namespace

FinitePress::FinitePress(const MeridianBody& body, const HyperelasticLaw& law, Boundary boundary, double r_limit)
    : body_(body), law_(law), surface_(std::make_unique<ContactSurface>(body, boundary, r_limit)) {
  state_.displacement = Eigen::VectorXd::Zero(body.n_unknowns());
  state_.pressure = Eigen::VectorXd::Zero(surface_->area().size());
  state_.active.assign(std::size_t(surface_->area().size()), false);
}

FinitePress::FinitePress(const MeridianBody& body, const HyperelasticLaw& law) : body_(body), law_(law) {
  state_.displacement = Eigen::VectorXd::Zero(body.n_unknowns());
}

double FinitePress::residual(const PressState& state, double* scale) const {
  Eigen::VectorXd force = body_.internal_force(law_, state.displacement);
  // The nodal forces before they cancel set the scale.
  *scale = force.norm();
  if (surface_) {
    force += surface_->loads() * state.pressure;
  }
  return body_.condensed(force).norm();
}

PressState FinitePress::full_step(double plate, const InterfaceLaw& interface, const PressState& state) {
  PressState next = state;
  const Eigen::VectorXd rest = body_.condensed(-body_.internal_force(law_, state.displacement));
  const SparseMatrix stiffness = body_.stiffness(law_, state.displacement);
  solver_.factorise(stiffness);
  if (!surface_) {
    next.displacement += body_.distributed(solver_.solve(rest));
    return next;
  }
  if (interface.rigid() && !solver_.is_positive()) {
    return held_step(plate, stiffness, rest, state);
  }
  const Eigen::VectorXd free = state.displacement + body_.distributed(solver_.solve(rest));
  const Eigen::MatrixXd compliance = solver_.condense(surface_->loads());
  const Eigen::VectorXd overlap = surface_->overlap(plate, free);
  const ContactSolution contact = solve({compliance, surface_->area(), overlap}, interface, state.active);
  next.pressure = contact.pressure;
  next.active = contact.active;
  next.active_set_iterations += contact.iterations;
  const Eigen::VectorXd pull = rest - body_.condensed(surface_->loads() * contact.pressure);
  next.displacement += body_.distributed(solver_.solve(pull));
  return next;
}

PressState FinitePress::held_step(double plate, const SparseMatrix& stiffness, const Eigen::VectorXd& rest,
                                  const PressState& state) {
  PressState next = state;
  const Eigen::VectorXd overlap = surface_->overlap(plate, state.displacement);
  for (int round = 0; round < max_held_rounds; ++round) {
    const std::vector<Eigen::Index> held = active_nodes(next.active);
    const SparseMatrix pressed = columns_of(*surface_, next.active);
    // Springs on what is held anyway change nothing but the definiteness of the matrix.
    const Eigen::VectorXd springs =
        (10 * stiffness.diagonal().mean()) * surface_->area()(held).cwiseAbs2().cwiseInverse();
    DirectSolver solver;
    solver.factorise(stiffness + SparseMatrix(pressed * springs.asDiagonal() * SparseMatrix(pressed.transpose())));
    const Eigen::VectorXd gap = overlap(held);
    const Eigen::VectorXd free = solver.solve(rest - body_.condensed(pressed * springs.cwiseProduct(gap)));
    const Eigen::VectorXd pressure =
        solver.condense(pressed).ldlt().solve(gap + pressed.transpose() * body_.distributed(free));
    next.displacement =
        state.displacement + body_.distributed(free - solver.solve(body_.condensed(pressed * pressure)));
    next.pressure.setZero();
    next.pressure(held) = pressure;
    ++next.active_set_iterations;
    const Eigen::VectorXd left = surface_->overlap(plate, next.displacement);
    const double slack = 1e-13 * overlap.cwiseAbs().maxCoeff();
    bool changed = false;
    for (std::size_t i = 0; i < next.active.size(); ++i) {
      const auto k = Eigen::Index(i);
      const bool active = next.active[i] ? next.pressure[k] >= 0 : left[k] > slack;
      changed = changed || active != next.active[i];
      next.active[i] = active;
    }
    if (!changed) {
      return next;
    }
  }
  throw NotSettled(
      fmt::format("the active set did not settle in {} rounds under an unstable tangent", max_held_rounds));
}

bool FinitePress::newton(double plate, const InterfaceLaw& interface, PressState& state) {
  double merit = std::numeric_limits<double>::infinity();
  for (int step = 0; step < max_newton; ++step) {
    const PressState next = full_step(plate, interface, state);
    double share = 1;
    for (int halvings = 0;; ++halvings) {
      share = std::ldexp(1.0, -halvings);
      if (share < shortest_step) {
        return false;
      }
      const PressState trial = between(state, next, share);
      try {
        double scale = 0;
        last_residual_ = residual(trial, &scale);
        last_goal_ = tolerance * scale;
      } catch (const Inverted&) {
        continue;
      }
      if (std::isfinite(last_residual_) &&
          (last_residual_ <= last_goal_ || last_residual_ < merit * (1 - 0.1 * share))) {
        state = trial;
        break;
      }
    }
    merit = last_residual_;
    ++state.newton_iterations;
    if (share == 1 && last_residual_ <= last_goal_) {
      return true;
    }
  }
  return false;
}

PressState FinitePress::press(double from, double plate, const InterfaceLaw& interface) {
  state_.newton_iterations = state_.active_set_iterations = 0;
  double at = from, step = plate - from;
  while (std::abs(plate - at) > 1e-14 * std::abs(plate)) {
    PressState trial = state_;
    bool settled = false;
    const double goal = std::abs(step) >= std::abs(plate - at) ? plate : at + step;
    try {
      settled = newton(goal, interface, trial);
    } catch (const Inverted&) {
    } catch (const NotSettled&) {
    }
    if (settled) {
      state_ = trial;
      at = goal;
      continue;
    }
    step /= 2;
    if (std::abs(step) < shortest_load * std::abs(plate - from)) {
      give_up(fmt::format(" at plate height {:.6g}, {:.1f} % of the way from {:.6g} to {:.6g},", goal,
                          100 * (at - from) / (plate - from), from, plate));
    }
  }
  PressState result = state_;
  result.overlap = surface_->overlap(plate, result.displacement).cwiseQuotient(surface_->area());
  result.force = surface_->area().dot(result.pressure);
  return result;
}

PressState FinitePress::move(const Eigen::VectorXd& guess) {
  state_.newton_iterations = 0;
  const Eigen::VectorXd whole = guess - state_.displacement;
  double at = 0, step = 1;
  while (at < 1) {
    PressState trial = state_;
    const double goal = std::min(1., at + step);
    trial.displacement += (goal - at) * whole;
    bool settled = false;
    try {
      settled = newton(0, {}, trial);
    } catch (const Inverted&) {
    }
    if (settled) {
      state_ = trial;
      at = goal;
      continue;
    }
    step /= 2;
    if (step < shortest_load) {
      give_up(fmt::format(" {:.1f} % of the way from the last load to the next", 100 * at));
    }
  }
  return state_;
}

double FinitePress::lowest_stiffness(const Eigen::VectorXd& u) {
  solver_.factorise(body_.stiffness(law_, u));
  SparseMatrix pressed(body_.n_unknowns(), 0);
  if (surface_) {
    pressed = columns_of(*surface_, state_.active);
  }
  const Eigen::LDLT<Eigen::MatrixXd> compliance(solver_.condense(pressed));
  Eigen::VectorXd x(body_.n_unknowns());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x[i] = std::sin(double(i)); // a start that is orthogonal to nothing
  }
  x = body_.condensed(x);
  double eigenvalue = 0;
  for (int step = 0; step < 60; ++step) {
    x.normalize();
    Eigen::VectorXd y = solver_.solve(x);
    if (pressed.cols() > 0) { // the plate holds what it presses
      y -= solver_.solve(pressed * compliance.solve(pressed.transpose() * y));
    }
    eigenvalue = 1 / x.dot(y);
    x = y;
  }
  return eigenvalue;
}

void FinitePress::give_up(const std::string& where) {
  const Ellipticity last = ellipticity(body_, law_, state_.displacement);
  const double unloaded = lowest_stiffness(Eigen::VectorXd::Zero(body_.n_unknowns()));
  const double left = lowest_stiffness(state_.displacement) / unloaded;
  // At rest it is the lower of the two wave moduli.
  const double at_rest = law_.lowest_acoustic(Gradient::Zero());
  const char* reason = last.lowest < 0.7 * at_rest ? "the law loses ellipticity here"
                       : left < 0.2 ? "the body is at its limit load: there is no equilibrium near by beyond it"
                                    : "the reason is not known; try smaller loads";
  throw NotSettled(
      fmt::format("Newton's method did not settle{} in load steps down to 1/{} of the load: residual {:.3e} (goal "
                  "{:.3e}). At the last settled state the lowest eigenvalue of the stiffness is {:.3g} of the unloaded "
                  "body's, that of the acoustic tensor {:.3e} (at r = {:.4g}, z = {:.4g}): {}",
                  where, 1 / shortest_load, last_residual_, last_goal_, left, last.lowest, last.r, last.z, reason));
}

Ellipticity ellipticity(const MeridianBody& body, const HyperelasticLaw& law, const Eigen::VectorXd& u) {
  Ellipticity result{std::numeric_limits<double>::infinity(), 0, 0};
  for (const auto& point : body.gradients(u)) {
    const double value = law.lowest_acoustic(point.gradient);
    if (!(value >= result.lowest)) {
      result = {value, point.r, point.z};
    }
  }
  return result;
}

double check_ellipticity(const MeridianBody& body, const HyperelasticLaw& law, const Eigen::VectorXd& u) {
  const Ellipticity found = ellipticity(body, law, u);
  if (!(found.lowest > 0)) {
    throw NotSettled(fmt::format("the law has lost ellipticity at r = {:.4g}, z = {:.4g}: lowest eigenvalue of the "
                                 "acoustic tensor {:.3e} (it must be > 0)",
                                 found.r, found.z, found.lowest));
  }
  return found.lowest;
}

} // namespace boba::continuum
