// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/contact/condensed_contact.h"
#include "continuum/elasticity/meridian_body.h"

namespace boba::continuum {

/// The part of a body's boundary that may touch a plate whose normal is z.
///
/// The contact pressure acts along z, per reference area, and is continuous and linear between the vertices of the
/// boundary; the gap is weighted with the same functions (a mortar method: with displacements of degree 2 the pair is
/// stable, and unlike nodal forces of quadratic elements its weights are positive, on the axis too).
class ContactSurface {
public:
  /// Takes the boundary's vertices out to r <= r_limit (and at least two).
  ContactSurface(const MeridianBody& body, Boundary boundary, double r_limit);

  /// Radius and height of the vertices, from the axis outward.
  const Eigen::VectorXd& r() const { return r_; }
  const Eigen::VectorXd& z() const { return z_; }
  /// Integral of the pressure functions.
  const Eigen::VectorXd& area() const { return area_; }
  /// Nodal forces (columns) of unit pressures, pointing to +z.
  const SparseMatrix& loads() const { return loads_; }
  /// Weighted overlap with a plate at height plate of the surface displaced by u.
  Eigen::VectorXd overlap(double plate, const Eigen::VectorXd& u) const;

private:
  Eigen::VectorXd r_, z_, area_, height_;
  SparseMatrix loads_;
};

} // namespace boba::continuum
