// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/contact/contact_surface.h"

namespace boba::continuum {

/// A body under a plate.
struct PressState {
  /// Displacement of all nodes.
  Eigen::VectorXd displacement;
  /// Pressure of the contact surface's vertices, per reference area, along z.
  Eigen::VectorXd pressure;
  /// Overlap of body and plate at the same vertices: >= 0 in a compliant layer, < 0 where they are apart.
  Eigen::VectorXd overlap;
  std::vector<bool> active;
  /// Force on the plate (whole circumference).
  double force = 0;
  int active_set_iterations = 0;
  int newton_iterations = 0;
};

/// A linear elastic body pressed by a plate: one factorisation and one condensed contact matrix for all loads.
class PlatePress {
public:
  /// Factorises the stiffness and condenses it on the boundary's vertices out to r_limit.
  PlatePress(const MeridianBody& body, const Material& material, Boundary boundary, double r_limit);

  const ContactSurface& surface() const { return surface_; }
  /// Equilibrium with the plate at height `plate`. Throws NotSettled. The last state's active set is the first guess.
  PressState press(double plate, const InterfaceLaw& interface, int max_active_sets);

private:
  const MeridianBody& body_;
  ContactSurface surface_;
  DirectSolver solver_;
  Eigen::MatrixXd compliance_;
  std::vector<bool> guess_;
};

/// Radius at which the contact ends. Rigid interface: the square of the pressure, which goes to zero linearly, is
/// extrapolated by a parabola from the outer part of the pressed vertices; compliant: where the overlap changes sign.
/// Returns 0 without contact.
double contact_edge(const Eigen::VectorXd& r, const PressState& state, const InterfaceLaw& interface);

/// Pressure on the axis, from an even polynomial through the inner half of the pressed vertices.
double central_pressure(const Eigen::VectorXd& r, const PressState& state, double edge);

} // namespace boba::continuum
