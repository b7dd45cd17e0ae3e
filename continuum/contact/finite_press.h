// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/contact/plate_press.h"
#include "continuum/elasticity/hyperelastic.h"

namespace boba::continuum {

/// A hyperelastic body, total Lagrangian: Newton's method with line search; load steps are halved when it fails.
///
/// The plate's constraint z + u_z <= plate stays linear in u, so each Newton step is the linear contact problem of the
/// tangent, condensed on the contact unknowns (a sequential quadratic programme).
class FinitePress {
public:
  /// Presses the boundary's vertices out to r_limit.
  FinitePress(const MeridianBody& body, const HyperelasticLaw& law, Boundary boundary, double r_limit);
  /// No contact: the held boundary moves.
  FinitePress(const MeridianBody& body, const HyperelasticLaw& law);

  const ContactSurface& surface() const { return *surface_; }
  /// Equilibrium with the plate at height `plate`, from `from` (the plate that just touches, or the last load).
  /// Throws NotSettled with the last residuals.
  PressState press(double from, double plate, const InterfaceLaw& interface);
  /// Equilibrium after the held boundary has moved; guess: a displacement of the whole body that moves it.
  PressState move(const Eigen::VectorXd& guess);

private:
  /// The state that a full Newton step leads to.
  PressState full_step(double plate, const InterfaceLaw& interface, const PressState& state);
  /// The same where the body alone is unstable under its pressures and only the plate, which holds it, makes it stable.
  PressState held_step(double plate, const SparseMatrix& stiffness, const Eigen::VectorXd& rest,
                       const PressState& state);
  bool newton(double plate, const InterfaceLaw& interface, PressState& state);
  double residual(const PressState& state, double* scale) const;
  /// Lowest eigenvalue of the tangent stiffness at u, with the pressed vertices held: it falls to 0 at a limit load.
  double lowest_stiffness(const Eigen::VectorXd& u);
  [[noreturn]] void give_up(const std::string& where);

  const MeridianBody& body_;
  const HyperelasticLaw& law_;
  std::unique_ptr<ContactSurface> surface_;
  DirectSolver solver_;
  PressState state_;
  double last_residual_ = 0;
  double last_goal_ = 0;
};

/// Lowest eigenvalue of the law's acoustic tensor over the integration points of the body, and where it is.
struct Ellipticity {
  double lowest, r, z;
};
Ellipticity ellipticity(const MeridianBody& body, const HyperelasticLaw& law, const Eigen::VectorXd& u);

/// Throws NotSettled when the law has lost ellipticity somewhere in the body, with the place; otherwise returns the
/// lowest eigenvalue of the acoustic tensor.
double check_ellipticity(const MeridianBody& body, const HyperelasticLaw& law, const Eigen::VectorXd& u);

} // namespace boba::continuum
