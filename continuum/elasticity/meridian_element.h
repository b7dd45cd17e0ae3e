// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/meridian_parts.h"

#include <deal.II/fe/fe_values.h>

namespace boba::continuum {

/// The integrals of one cell of a MeridianBody: B^T A B and B^T P with the weight 2 pi r.
class MeridianElement {
public:
  /// points_per_direction: order of the Gauss rule.
  MeridianElement(const MeridianBody::Parts& parts, unsigned points_per_direction);

  void reinit(const dealii::DoFHandler<2>::active_cell_iterator& cell);
  /// The entries of u on the cell.
  Eigen::VectorXd local(const Eigen::VectorXd& u, const std::vector<dealii::types::global_dof_index>& indices) const;

  /// projected_lame: modulus of the projected divergence, 0 for none (then the law holds the volume part).
  Eigen::MatrixXd stiffness(const GradientLaw& law, double projected_lame, const Eigen::VectorXd& u) const;
  Eigen::VectorXd force(const GradientLaw& law, double projected_lame, const Eigen::VectorXd& u) const;
  Eigen::VectorXd body_force(const std::function<Eigen::Vector2d(double, double)>& value) const;
  /// Appends the Cauchy stress of the cell's integration points.
  void append_stress(const GradientLaw& law, double projected_lame, const Eigen::VectorXd& u, bool finite,
                     std::vector<StressPoint>& result) const;
  void append_gradients(const Eigen::VectorXd& u, std::vector<GradientPoint>& result) const;
  Eigen::Vector2d squared_error(const Eigen::VectorXd& u, const std::function<Eigen::Vector2d(double, double)>& value,
                                const std::function<Gradient(double, double)>& gradient) const;

private:
  using Operator = Eigen::Matrix<double, 5, Eigen::Dynamic>;

  /// Rows: integration points; columns: unknowns; entry: divergence, projected on polynomials of degree k - 1.
  Eigen::MatrixXd projected_divergence() const;

  unsigned pressure_degree_;
  dealii::FEValues<2> values_;
  unsigned n_dofs_;
  std::vector<unsigned> component_;
  std::vector<Operator> gradient_;
  std::vector<double> weight_;
};

} // namespace boba::continuum
