// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/meridian_element.h"

#include <deal.II/base/quadrature_lib.h>
#include <numbers>

namespace boba::continuum {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

/// Monomials x^i y^j with i + j <= degree.
Eigen::VectorXd monomials(const dealii::Point<2>& point, unsigned degree) {
  Eigen::VectorXd result((degree + 1) * (degree + 2) / 2);
  Eigen::Index k = 0;
  for (unsigned i = 0; i <= degree; ++i) {
    for (unsigned j = 0; i + j <= degree; ++j) {
      result[k++] = std::pow(point[0] - 0.5, i) * std::pow(point[1] - 0.5, j);
    }
  }
  return result;
}

/// Cauchy stress J^-1 P F^T from the Piola stress; the small-strain stress is the Piola stress itself.
StressPoint cauchy(const Gradient& h, const Gradient& p, double weight, bool finite) {
  if (!finite) {
    return {0, 0, p[0], p[3], p[4], 0.5 * (p[1] + p[2]), weight};
  }
  Eigen::Matrix2d f, piola;
  f << 1 + h[0], h[1], h[2], 1 + h[3];
  piola << p[0], p[1], p[2], p[3];
  const double j = f.determinant() * (1 + h[4]);
  const Eigen::Matrix2d sigma = piola * f.transpose() / j;
  return {0, 0, sigma(0, 0), sigma(1, 1), p[4] * (1 + h[4]) / j, 0.5 * (sigma(0, 1) + sigma(1, 0)), weight * j};
}

} // namespace

MeridianElement::MeridianElement(const MeridianBody::Parts& parts, unsigned points_per_direction)
    : pressure_degree_(parts.discretisation.degree - 1),
      values_(parts.mapping, parts.element, dealii::QGauss<2>(points_per_direction),
              dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points |
                  dealii::update_JxW_values),
      n_dofs_(parts.element.n_dofs_per_cell()), component_(n_dofs_),
      gradient_(values_.n_quadrature_points, Operator::Zero(5, n_dofs_)), weight_(values_.n_quadrature_points) {
  for (unsigned i = 0; i < n_dofs_; ++i) {
    component_[i] = parts.element.system_to_component_index(i).first;
  }
}

void MeridianElement::reinit(const dealii::DoFHandler<2>::active_cell_iterator& cell) {
  values_.reinit(cell);
  for (const unsigned q : values_.quadrature_point_indices()) {
    const double r = values_.quadrature_point(q)[0];
    weight_[q] = two_pi * r * values_.JxW(q);
    for (unsigned i = 0; i < n_dofs_; ++i) {
      const auto slope = values_.shape_grad(i, q);
      if (component_[i] == 0) {
        gradient_[q](0, i) = slope[0];
        gradient_[q](1, i) = slope[1];
        gradient_[q](4, i) = values_.shape_value(i, q) / r;
      } else {
        gradient_[q](2, i) = slope[0];
        gradient_[q](3, i) = slope[1];
      }
    }
  }
}

Eigen::VectorXd MeridianElement::local(const Eigen::VectorXd& u,
                                       const std::vector<dealii::types::global_dof_index>& indices) const {
  Eigen::VectorXd result(n_dofs_);
  for (unsigned i = 0; i < n_dofs_; ++i) {
    result[i] = u[indices[i]];
  }
  return result;
}

Eigen::MatrixXd MeridianElement::projected_divergence() const {
  const auto n_points = Eigen::Index(weight_.size());
  const auto n_pressure = Eigen::Index((pressure_degree_ + 1) * (pressure_degree_ + 2) / 2);
  Eigen::MatrixXd basis(n_points, n_pressure), divergence(n_points, n_dofs_);
  Eigen::VectorXd weights(n_points);
  for (Eigen::Index q = 0; q < n_points; ++q) {
    const auto& g = gradient_[std::size_t(q)];
    basis.row(q) = monomials(values_.get_quadrature().point(unsigned(q)), pressure_degree_).transpose();
    divergence.row(q) = g.row(0) + g.row(3) + g.row(4);
    weights[q] = weight_[std::size_t(q)];
  }
  const Eigen::MatrixXd weighted = weights.asDiagonal() * basis;
  const Eigen::MatrixXd mass = basis.transpose() * weighted;
  return basis * mass.ldlt().solve(weighted.transpose() * divergence);
}

Eigen::MatrixXd MeridianElement::stiffness(const GradientLaw& law, double projected_lame,
                                           const Eigen::VectorXd& u) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n_dofs_, n_dofs_);
  Operator weighted(5, n_dofs_);
  for (std::size_t q = 0; q < weight_.size(); ++q) {
    const GradientResponse response = law.at(gradient_[q] * u);
    weighted.noalias() = (weight_[q] * response.tangent) * gradient_[q];
    result.noalias() += gradient_[q].transpose() * weighted;
  }
  if (projected_lame != 0) {
    const Eigen::MatrixXd divergence = projected_divergence();
    for (std::size_t q = 0; q < weight_.size(); ++q) {
      const auto row = divergence.row(Eigen::Index(q));
      result.noalias() += (projected_lame * weight_[q]) * row.transpose() * row;
    }
  }
  return result;
}

Eigen::VectorXd MeridianElement::force(const GradientLaw& law, double projected_lame, const Eigen::VectorXd& u) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(n_dofs_);
  for (std::size_t q = 0; q < weight_.size(); ++q) {
    result += weight_[q] * (gradient_[q].transpose() * law.at(gradient_[q] * u).stress);
  }
  if (projected_lame != 0) {
    const Eigen::MatrixXd divergence = projected_divergence();
    for (std::size_t q = 0; q < weight_.size(); ++q) {
      const auto row = divergence.row(Eigen::Index(q));
      result += (projected_lame * weight_[q] * row.dot(u)) * row.transpose();
    }
  }
  return result;
}

Eigen::VectorXd MeridianElement::body_force(const std::function<Eigen::Vector2d(double, double)>& value) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(n_dofs_);
  for (const unsigned q : values_.quadrature_point_indices()) {
    const auto x = values_.quadrature_point(q);
    const Eigen::Vector2d f = value(x[0], x[1]);
    for (unsigned i = 0; i < n_dofs_; ++i) {
      result[i] += weight_[q] * values_.shape_value(i, q) * f[component_[i]];
    }
  }
  return result;
}

void MeridianElement::append_stress(const GradientLaw& law, double projected_lame, const Eigen::VectorXd& u,
                                    bool finite, std::vector<StressPoint>& result) const {
  const Eigen::VectorXd volume = projected_lame != 0 ? Eigen::VectorXd(projected_divergence() * u)
                                                     : Eigen::VectorXd::Zero(Eigen::Index(weight_.size()));
  for (const unsigned q : values_.quadrature_point_indices()) {
    const Gradient gradient = gradient_[q] * u;
    Gradient piola = law.at(gradient).stress;
    const double pressure = projected_lame * volume[q];
    piola[0] += pressure;
    piola[3] += pressure;
    piola[4] += pressure;
    StressPoint point = cauchy(gradient, piola, weight_[q], finite);
    point.r = values_.quadrature_point(q)[0];
    point.z = values_.quadrature_point(q)[1];
    result.push_back(point);
  }
}

void MeridianElement::append_gradients(const Eigen::VectorXd& u, std::vector<GradientPoint>& result) const {
  for (const unsigned q : values_.quadrature_point_indices()) {
    const auto x = values_.quadrature_point(q);
    result.push_back({x[0], x[1], gradient_[q] * u});
  }
}

Eigen::Vector2d MeridianElement::squared_error(const Eigen::VectorXd& u,
                                               const std::function<Eigen::Vector2d(double, double)>& value,
                                               const std::function<Gradient(double, double)>& gradient) const {
  Eigen::Vector2d result = Eigen::Vector2d::Zero();
  for (const unsigned q : values_.quadrature_point_indices()) {
    const auto x = values_.quadrature_point(q);
    Eigen::Vector2d found = Eigen::Vector2d::Zero();
    for (unsigned i = 0; i < n_dofs_; ++i) {
      found[component_[i]] += u[i] * values_.shape_value(i, q);
    }
    result[0] += weight_[q] * (found - value(x[0], x[1])).squaredNorm();
    result[1] += weight_[q] * (gradient_[q] * u - gradient(x[0], x[1])).squaredNorm();
  }
  return result;
}

} // namespace boba::continuum
