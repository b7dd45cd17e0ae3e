// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/contact/compressed_body.h"
#include "continuum/contact/finite_press.h"
#include "continuum/sphere/hertz.h"
#include "continuum/sphere/sphere_mesh.h"

namespace boba::continuum {

/// One sphere between two frictionless plates (by symmetry also two equal spheres against each other).
struct SphereProblem : CompressedBody {
  /// Approaches of the two plates, total: each plate travels half.
  std::vector<double> approaches;
  /// Elements across the contact radius at its edge; at least 8.
  double elements_across = 48;
  /// Changes of the set of pressed nodes after which a load has failed; at least 1.
  int max_active_sets = most_active_sets;
};

struct SphereLoad : CompressionLoad {
  double approach = 0;
  /// Radius of the contact: where it lies now with finite kinematics, on the unpressed body with linear ones.
  double contact_radius = 0;
  double reference_contact_radius = 0;
  /// Largest pressure per reference area, and the one on the axis.
  double peak_pressure = 0;
  double central_pressure = 0;
  /// Radial displacement of the equator.
  double equatorial_bulge = 0;
  /// What Hertz's theory says at the same approach.
  Hertz hertz{};
  int active_set_iterations = 0;
  int n_unknowns = 0;
  int n_contact_unknowns = 0;
  /// r, p, overlap of the vertices of the contact surface.
  Eigen::VectorXd r, pressure, overlap;
  std::shared_ptr<MeridianBody> body;
};

/// Throws std::invalid_argument (name, value, range) for a problem that cannot be posed.
void check(const SphereProblem& problem);

/// Solves all loads in order. Loads whose contact radii are within a factor share a mesh and its factorisation.
/// Throws what check() throws, NotSettled for a failed iteration.
std::vector<SphereLoad> solve(const SphereProblem& problem);

} // namespace boba::continuum
