// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/material.h"

#include <Eigen/Core>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <functional>
#include <vector>

namespace boba::continuum {

using VectorField = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;
/// d u_i / d x_j of a displacement field.
using GradientField = std::function<Eigen::Matrix3d(const Eigen::Vector3d&)>;

/// The integrals of one cell of an octant. Entries are ordered as the unknowns of the (vector-valued) element.
class OctantElement {
public:
  /// Both are kept by reference.
  OctantElement(const dealii::Mapping<3>& mapping, const dealii::FESystem<3>& element, unsigned points_per_direction);

  void reinit(const dealii::Triangulation<3>::cell_iterator& cell);
  /// projected: the divergence is projected on polynomials one degree lower (see Formulation::projected).
  Eigen::MatrixXd stiffness(const Material& material, bool projected) const;
  Eigen::VectorXd body_force(const VectorField& force) const;
  /// Squares of the L2 norms of the error of u and of its gradient.
  Eigen::Vector2d squared_error(const Eigen::VectorXd& u, const VectorField& value,
                                const GradientField& gradient) const;

private:
  Eigen::Index at(unsigned node, unsigned component) const { return index_[3 * node + component]; }
  void add_volume(double lame, Eigen::MatrixXd& k) const;

  dealii::FEValues<3> values_;
  unsigned pressure_degree_;
  /// Index in the element of component c of node k, at 3 k + c.
  std::vector<Eigen::Index> index_;
  /// Slope of the node's function (columns) along x, y, z at the integration points (rows), and their weights.
  Eigen::MatrixXd slope_[3];
  Eigen::VectorXd weight_;
};

} // namespace boba::continuum
