// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/contact/plate_press.h"

#include "continuum/contact/pressure_profile.h"

#include <algorithm>

namespace boba::continuum {
namespace {

double sign_change(const Eigen::VectorXd& r, const Eigen::VectorXd& overlap, Eigen::Index last) {
  if (last + 1 >= r.size()) {
    return r[last];
  }
  const double t = overlap[last] / (overlap[last] - overlap[last + 1]);
  return r[last] + t * (r[last + 1] - r[last]);
}

/// The vertices from the axis to the given one.
std::vector<ProfilePoint> pressed_points(const Eigen::VectorXd& r, const PressState& state, Eigen::Index last) {
  std::vector<ProfilePoint> points;
  for (Eigen::Index i = 0; i <= last; ++i) {
    points.push_back({r[i], state.pressure[i]});
  }
  return points;
}

} // namespace

PlatePress::PlatePress(const MeridianBody& body, const Material& material, Boundary boundary, double r_limit)
    : body_(body), surface_(body, boundary, r_limit) {
  solver_.factorise(body.stiffness(material));
  compliance_ = solver_.condense(surface_.loads());
}

PressState PlatePress::press(double plate, const InterfaceLaw& interface, int max_active_sets) {
  const Eigen::VectorXd rest = surface_.overlap(plate, Eigen::VectorXd::Zero(body_.n_unknowns()));
  if (guess_.empty()) {
    guess_.resize(std::size_t(rest.size()));
    for (std::size_t i = 0; i < guess_.size(); ++i) {
      guess_[i] = rest[Eigen::Index(i)] > 0;
    }
  }
  const ContactSolution contact = solve({compliance_, surface_.area(), rest}, interface, guess_, max_active_sets);
  guess_ = contact.active;
  PressState state;
  state.pressure = contact.pressure;
  state.active = contact.active;
  state.active_set_iterations = contact.iterations;
  state.displacement = body_.distributed(solver_.solve(body_.condensed(-(surface_.loads() * contact.pressure))));
  state.overlap = (rest - compliance_ * contact.pressure).cwiseQuotient(surface_.area());
  state.force = surface_.area().dot(contact.pressure);
  return state;
}

double contact_edge(const Eigen::VectorXd& r, const PressState& state, const InterfaceLaw& interface) {
  const auto last_active = std::find(state.active.rbegin(), state.active.rend(), true);
  if (last_active == state.active.rend()) {
    return 0;
  }
  const auto last = Eigen::Index(state.active.rend() - last_active) - 1;
  if (!interface.rigid()) {
    return sign_change(r, state.overlap, last);
  }
  // The two outermost pressed vertices carry the error of the broken element.
  const double spacing = r[last] - r[std::max<Eigen::Index>(last - 1, 0)];
  return extrapolated_edge(pressed_points(r, state, last), 1.5 * spacing, 0.6);
}

double central_pressure(const Eigen::VectorXd& r, const PressState& state, double edge) {
  return pressure_on_axis(pressed_points(r, state, r.size() - 1), edge);
}

} // namespace boba::continuum
