// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/contact/plate_press.h"

#include <Eigen/QR>
#include <algorithm>

namespace boba::continuum {
namespace {

/// Coefficients of the polynomial in x of the given degree that fits y best.
Eigen::VectorXd polynomial_fit(const std::vector<double>& x, const std::vector<double>& y, int degree) {
  Eigen::MatrixXd powers(Eigen::Index(x.size()), degree + 1);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int k = 0; k <= degree; ++k) {
      powers(Eigen::Index(i), k) = std::pow(x[i], k);
    }
  }
  return powers.colPivHouseholderQr().solve(Eigen::Map<const Eigen::VectorXd>(y.data(), Eigen::Index(y.size())));
}

double sign_change(const Eigen::VectorXd& r, const Eigen::VectorXd& overlap, Eigen::Index last) {
  if (last + 1 >= r.size()) {
    return r[last];
  }
  const double t = overlap[last] / (overlap[last] - overlap[last + 1]);
  return r[last] + t * (r[last + 1] - r[last]);
}

} // namespace

PlatePress::PlatePress(const MeridianBody& body, const Material& material, Boundary boundary, double r_limit)
    : body_(body), surface_(body, boundary, r_limit) {
  solver_.factorise(body.stiffness(material));
  compliance_ = solver_.condense(surface_.loads());
}

PressState PlatePress::press(double plate, const InterfaceLaw& interface) {
  const Eigen::VectorXd rest = surface_.overlap(plate, Eigen::VectorXd::Zero(body_.n_unknowns()));
  if (guess_.empty()) {
    guess_.resize(std::size_t(rest.size()));
    for (std::size_t i = 0; i < guess_.size(); ++i) {
      guess_[i] = rest[Eigen::Index(i)] > 0;
    }
  }
  const ContactSolution contact = solve({compliance_, surface_.area(), rest}, interface, guess_);
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
  // The vertex next to the edge carries the error of the broken element and is left out.
  std::vector<double> squares, pressures;
  for (Eigen::Index i = 0; i + 1 < last; ++i) {
    if (r[i] > 0.6 * r[last]) {
      squares.push_back(r[i] * r[i]);
      pressures.push_back(state.pressure[i] * state.pressure[i]);
    }
  }
  if (squares.size() < 5) {
    return r[last];
  }
  const Eigen::VectorXd fit = polynomial_fit(squares, pressures, 2);
  double square = r[last] * r[last];
  for (int step = 0; step < 20; ++step) {
    square -= (fit[0] + square * (fit[1] + square * fit[2])) / (fit[1] + 2 * square * fit[2]);
  }
  // The edge lies beside the last pressed vertex; a fit that says otherwise is not one.
  const double edge = std::sqrt(std::max(0., square));
  const double spacing = r[last] - r[last - 1];
  return std::abs(edge - r[last]) < 3 * spacing ? edge : r[last];
}

double central_pressure(const Eigen::VectorXd& r, const PressState& state, double edge) {
  std::vector<double> squares, pressures;
  for (Eigen::Index i = 0; i < r.size() && (r[i] < 0.5 * edge || squares.size() < 3); ++i) {
    squares.push_back(r[i] * r[i]);
    pressures.push_back(state.pressure[i]);
  }
  return polynomial_fit(squares, pressures, squares.size() > 5 ? 2 : 1)[0];
}

} // namespace boba::continuum
