// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/octant/octant_element.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <deal.II/base/quadrature_lib.h>

namespace boba::continuum {
namespace {

Eigen::Vector3d place(const dealii::Point<3>& x) {
  return {x[0], x[1], x[2]};
}

/// 1 for degree 0; 1, x, y, z for degree 1.
Eigen::RowVectorXd monomials(const dealii::Point<3>& x, unsigned degree) {
  Eigen::RowVectorXd result(degree == 0 ? 1 : 4);
  result[0] = 1;
  for (Eigen::Index c = 1; c < result.size(); ++c) {
    result[c] = x[unsigned(c - 1)];
  }
  return result;
}

} // namespace

OctantElement::OctantElement(const dealii::Mapping<3>& mapping, const dealii::FESystem<3>& element,
                             unsigned points_per_direction)
    : values_(mapping, element.base_element(0), dealii::QGauss<3>(points_per_direction),
              dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points |
                  dealii::update_JxW_values),
      pressure_degree_(element.degree - 1), index_(element.n_dofs_per_cell()), weight_(values_.n_quadrature_points) {
  for (unsigned i = 0; i < element.n_dofs_per_cell(); ++i) {
    const auto [component, node] = element.system_to_component_index(i);
    index_[3 * node + component] = i;
  }
  for (auto& slope : slope_) {
    slope.resize(values_.n_quadrature_points, values_.dofs_per_cell);
  }
}

void OctantElement::reinit(const dealii::Triangulation<3>::cell_iterator& cell) {
  values_.reinit(cell);
  for (const unsigned q : values_.quadrature_point_indices()) {
    weight_[q] = values_.JxW(q);
    for (unsigned k = 0; k < values_.dofs_per_cell; ++k) {
      for (unsigned c = 0; c < 3; ++c) {
        slope_[c](q, k) = values_.shape_grad(k, q)[c];
      }
    }
  }
}

Eigen::MatrixXd OctantElement::stiffness(const Material& material, bool projected) const {
  const unsigned n = values_.dofs_per_cell;
  const double shear = material.shear(), lame = projected ? 0 : material.lame();
  // integral[c][d](k, l): slope of k along c times slope of l along d.
  Eigen::MatrixXd integral[3][3], laplace = Eigen::MatrixXd::Zero(n, n);
  for (unsigned c = 0; c < 3; ++c) {
    const Eigen::MatrixXd weighted = weight_.asDiagonal() * slope_[c];
    for (unsigned d = 0; d <= c; ++d) {
      integral[c][d].noalias() = weighted.transpose() * slope_[d];
      integral[d][c] = integral[c][d].transpose();
    }
    laplace += integral[c][c];
  }
  Eigen::MatrixXd result(3 * n, 3 * n);
  for (unsigned k = 0; k < n; ++k) {
    for (unsigned l = 0; l < n; ++l) {
      for (unsigned c = 0; c < 3; ++c) {
        for (unsigned d = 0; d < 3; ++d) {
          result(at(k, c), at(l, d)) =
              lame * integral[c][d](k, l) + shear * integral[d][c](k, l) + (c == d ? shear * laplace(k, l) : 0);
        }
      }
    }
  }
  if (projected) {
    add_volume(material.lame(), result);
  }
  return result;
}

void OctantElement::add_volume(double lame, Eigen::MatrixXd& k) const {
  const Eigen::Index n_points = weight_.size();
  Eigen::MatrixXd basis(n_points, pressure_degree_ == 0 ? 1 : 4), divergence(n_points, k.rows());
  for (Eigen::Index q = 0; q < n_points; ++q) {
    basis.row(q) = monomials(values_.get_quadrature().point(unsigned(q)), pressure_degree_);
  }
  for (unsigned node = 0; node < values_.dofs_per_cell; ++node) {
    for (unsigned c = 0; c < 3; ++c) {
      divergence.col(at(node, c)) = slope_[c].col(node);
    }
  }
  // With D the divergence at the points, W the weights and B the basis: D^T W B (B^T W B)^-1 B^T W D.
  const Eigen::MatrixXd weighted = weight_.asDiagonal() * basis;
  const Eigen::MatrixXd moments = weighted.transpose() * divergence;
  k.noalias() += lame * moments.transpose() * (basis.transpose() * weighted).ldlt().solve(moments);
}

Eigen::VectorXd OctantElement::body_force(const VectorField& force) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(Eigen::Index(index_.size()));
  for (const unsigned q : values_.quadrature_point_indices()) {
    const Eigen::Vector3d f = values_.JxW(q) * force(place(values_.quadrature_point(q)));
    for (unsigned k = 0; k < values_.dofs_per_cell; ++k) {
      for (unsigned c = 0; c < 3; ++c) {
        result[at(k, c)] += values_.shape_value(k, q) * f[c];
      }
    }
  }
  return result;
}

Eigen::Vector2d OctantElement::squared_error(const Eigen::VectorXd& u, const VectorField& value,
                                             const GradientField& gradient) const {
  Eigen::Vector2d result = Eigen::Vector2d::Zero();
  for (const unsigned q : values_.quadrature_point_indices()) {
    const Eigen::Vector3d x = place(values_.quadrature_point(q));
    Eigen::Vector3d miss = -value(x);
    Eigen::Matrix3d slope_miss = -gradient(x);
    for (unsigned k = 0; k < values_.dofs_per_cell; ++k) {
      for (unsigned c = 0; c < 3; ++c) {
        miss[c] += u[at(k, c)] * values_.shape_value(k, q);
        for (unsigned d = 0; d < 3; ++d) {
          slope_miss(c, d) += u[at(k, c)] * slope_[d](q, k);
        }
      }
    }
    result += weight_[q] * Eigen::Vector2d(miss.squaredNorm(), slope_miss.squaredNorm());
  }
  return result;
}

} // namespace boba::continuum
