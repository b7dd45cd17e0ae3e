// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/contact/condensed_contact.h"
#include "continuum/elasticity/material.h"
#include "continuum/elasticity/meridian_body.h"
#include "continuum/octant/duration.h"
#include "continuum/octant/multigrid.h"
#include "continuum/octant/octant_shape.h"

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace boba::continuum {

class OctantSystem;

/// A solved octant; forces are those of the whole circumference (four octants).
struct OctantSolution {
  double force = 0;
  /// Pressure on the axis and radius of the contact, as in the axisymmetric solver. 0 if not pressed.
  double central_pressure = 0;
  double contact_radius = 0;
  /// Radius and pressure (per reference area, along z) of the pressed nodes of all angles, from the axis outward.
  Eigen::VectorXd r, pressure;
  /// Vertices of the free side or of the surface in the plane y = 0, from mid-height upward.
  std::vector<FieldPoint> profile;
  /// Conjugate-gradient iterations of the last linear system, and how often the active set changed.
  int iterations = 0;
  int active_set_iterations = 0;
  long n_unknowns = 0;
  Duration assemble, precondition, solve;
};

/// Small-strain elasticity on an octant in three dimensions: p4est mesh, conjugate gradients with algebraic multigrid.
///
/// Runs on all ranks of MPI_COMM_WORLD, which must be initialised (MpiSession) by the caller; every function is
/// collective.
class OctantBody {
public:
  /// Throws std::invalid_argument for a degree other than 1 and 2. The projected form is taken where
  /// `discretisation.formulation` says so (automatic: nu > 0.45).
  OctantBody(const OctantShape& shape, const Discretisation& discretisation, Multigrid multigrid = Multigrid::gamg);
  ~OctantBody();

  /// The end moved by -shortening / 2; bonded: u_x = u_y = 0 there. Throws NotSettled.
  OctantSolution solve_held(const Material& material, double shortening, bool bonded);
  /// A rigid frictionless plate at height `plate`; first_radius: first guess of the contact.
  /// Throws NotSettled, with the last residuals, when the active set still changes after max_active_sets solutions.
  OctantSolution press(const Material& material, double plate, double first_radius,
                       int max_active_sets = most_active_sets);
  /// The displacement given on the whole boundary apart from the mirrors, under a body force (force per volume).
  OctantSolution solve_prescribed(const Material& material,
                                  const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& value,
                                  const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& body_force);
  /// L2 norms, over the octant, of the error of the last displacement and of its gradient d u_i / d x_j.
  Eigen::Vector2d error(const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& value,
                        const std::function<Eigen::Matrix3d(const Eigen::Vector3d&)>& gradient) const;
  /// Writes displacement and stress of the last solution as folder/fields_NNNN_0.vtu and fields_NNNN.pvtu.
  void write(const std::string& folder, unsigned number) const;

private:
  void assemble(const Material& material, OctantSolution& solution);
  void finish(OctantSolution& solution) const;

  Discretisation discretisation_;
  Multigrid multigrid_;
  Material material_;
  std::unique_ptr<OctantSystem> system_;
};

} // namespace boba::continuum
