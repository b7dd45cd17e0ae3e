// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/meridian_body.h"

#include "continuum/elasticity/meridian_element.h"
#include "continuum/elasticity/meridian_parts.h"

#include <algorithm>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/vector_tools.h>
#include <fmt/format.h>
#include <map>
#include <stdexcept>

namespace boba::continuum {
namespace {

using dealii::types::global_dof_index;

unsigned checked_degree(unsigned degree) {
  if (degree < 1 || degree > 4) {
    throw std::invalid_argument(fmt::format("degree = {} is not allowed: it must be 1, 2, 3 or 4", degree));
  }
  return degree;
}

class PairFunction : public dealii::Function<2> {
public:
  explicit PairFunction(const std::function<Eigen::Vector2d(double, double)>& value)
      : dealii::Function<2>(2), value_(value) {}
  double value(const dealii::Point<2>& point, unsigned component) const override {
    return value_(point[0], point[1])[component];
  }

private:
  const std::function<Eigen::Vector2d(double, double)>& value_;
};

dealii::Vector<double> to_dealii(const Eigen::VectorXd& values) {
  dealii::Vector<double> result(static_cast<unsigned>(values.size()));
  std::copy(values.data(), values.data() + values.size(), result.begin());
  return result;
}

Eigen::VectorXd to_eigen(const dealii::Vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), Eigen::Index(values.size()));
}

dealii::ComponentMask mask(bool radial, bool axial) {
  return dealii::ComponentMask(std::vector<bool>{radial, axial});
}

SparseMatrix to_eigen(const dealii::SparseMatrix<double>& matrix) {
  const int n = int(matrix.m());
  SparseMatrix result(n, n);
  std::vector<int> counts(static_cast<std::size_t>(n));
  for (unsigned row = 0; row < matrix.m(); ++row) {
    counts[row] = int(matrix.get_row_length(row));
  }
  result.reserve(counts);
  // deal.II keeps rows with the diagonal first; the matrix is symmetric, so its rows are Eigen's columns.
  for (unsigned row = 0; row < matrix.m(); ++row) {
    for (auto it = matrix.begin(row); it != matrix.end(row); ++it) {
      result.insert(int(it->column()), int(row)) = it->value();
    }
  }
  result.makeCompressed();
  return result;
}

/// u with its hanging nodes filled from their masters.
Eigen::VectorXd with_hanging(const MeridianBody::Parts& parts, const Eigen::VectorXd& u) {
  auto values = to_dealii(u);
  parts.hanging.distribute(values);
  return to_eigen(values);
}

/// What an element needs of the material: a law, and the volume modulus that is treated apart (0: none).
struct ElementLaw {
  const GradientLaw& law;
  double projected_lame;
};

} // namespace

bool is_projected(Formulation formulation, const Material& material) {
  return formulation == Formulation::projected || (formulation == Formulation::automatic && material.poisson > 0.45);
}

MeridianBody::Parts::Parts(MeridianMesh given, Discretisation choice, Held held_there)
    : mesh(std::move(given)), discretisation(choice), held(held_there),
      element(dealii::FE_Q<2>(checked_degree(choice.degree)), 2), mapping(mesh.mapping_degree),
      dofs(*mesh.triangulation) {
  dofs.distribute_dofs(element);
  dealii::DoFTools::make_hanging_node_constraints(dofs, hanging);
  constraints.merge(hanging);
  hanging.close();
  dealii::DoFTools::make_zero_boundary_constraints(dofs, axis, constraints, mask(true, false));
  dealii::DoFTools::make_zero_boundary_constraints(dofs, mid_plane, constraints, mask(false, true));
  if (held.radial || held.axial) {
    dealii::DoFTools::make_zero_boundary_constraints(dofs, held.boundary, constraints, mask(held.radial, held.axial));
  }
  constraints.close();
  dealii::DynamicSparsityPattern dynamic(dofs.n_dofs());
  dealii::DoFTools::make_sparsity_pattern(dofs, dynamic, constraints, false);
  pattern.copy_from(dynamic);
}

MeridianBody::MeridianBody(MeridianMesh mesh, Discretisation discretisation, Held held)
    : parts_(std::make_unique<Parts>(std::move(mesh), discretisation, held)) {}
MeridianBody::MeridianBody(MeridianMesh mesh, Discretisation discretisation)
    : MeridianBody(std::move(mesh), discretisation, Held{}) {}
MeridianBody::~MeridianBody() = default;
MeridianBody::MeridianBody(MeridianBody&&) noexcept = default;

int MeridianBody::n_unknowns() const {
  return int(parts_->dofs.n_dofs());
}
int MeridianBody::n_cells() const {
  return int(parts_->mesh.triangulation->n_active_cells());
}

namespace {

SparseMatrix assemble_stiffness(const MeridianBody::Parts& parts, const ElementLaw& law, const Eigen::VectorXd& u) {
  dealii::SparseMatrix<double> matrix(parts.pattern);
  MeridianElement element(parts, parts.discretisation.degree + 1);
  const unsigned n = parts.element.n_dofs_per_cell();
  dealii::FullMatrix<double> local(n, n);
  std::vector<global_dof_index> indices(n);
  for (const auto& cell : parts.dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    element.reinit(cell);
    const Eigen::MatrixXd stiffness = element.stiffness(law.law, law.projected_lame, element.local(u, indices));
    for (unsigned i = 0; i < n; ++i) {
      for (unsigned j = 0; j < n; ++j) {
        local(i, j) = stiffness(i, j);
      }
    }
    parts.constraints.distribute_local_to_global(local, indices, matrix);
  }
  return to_eigen(matrix);
}

Eigen::VectorXd assemble_force(const MeridianBody::Parts& parts, const ElementLaw& law, const Eigen::VectorXd& u) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(Eigen::Index(parts.dofs.n_dofs()));
  MeridianElement element(parts, parts.discretisation.degree + 1);
  std::vector<global_dof_index> indices(parts.element.n_dofs_per_cell());
  for (const auto& cell : parts.dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    element.reinit(cell);
    const Eigen::VectorXd local = element.force(law.law, law.projected_lame, element.local(u, indices));
    for (std::size_t i = 0; i < indices.size(); ++i) {
      force[indices[i]] += local[Eigen::Index(i)];
    }
  }
  return force;
}

/// Runs work(ElementLaw) with the linear law of the material in the formulation that suits it.
template <class Work> auto with_linear(const MeridianBody::Parts& parts, const Material& material, Work&& work) {
  const bool projected = is_projected(parts.discretisation.formulation, material);
  const LinearLaw law(material.shear(), projected ? 0 : material.lame());
  return work(ElementLaw{law, projected ? material.lame() : 0});
}

std::vector<StressPoint> collect_stress(const MeridianBody::Parts& parts, const ElementLaw& law,
                                        const Eigen::VectorXd& u, bool finite) {
  std::vector<StressPoint> result;
  MeridianElement element(parts, parts.discretisation.degree);
  std::vector<global_dof_index> indices(parts.element.n_dofs_per_cell());
  for (const auto& cell : parts.dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    element.reinit(cell);
    element.append_stress(law.law, law.projected_lame, element.local(u, indices), finite, result);
  }
  return result;
}

} // namespace

SparseMatrix MeridianBody::stiffness(const GradientLaw& law, const Eigen::VectorXd& u) const {
  return assemble_stiffness(*parts_, {law, 0}, u);
}

SparseMatrix MeridianBody::stiffness(const Material& material) const {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n_unknowns());
  return with_linear(*parts_, material, [&](const ElementLaw& law) { return assemble_stiffness(*parts_, law, zero); });
}

Eigen::VectorXd MeridianBody::internal_force(const GradientLaw& law, const Eigen::VectorXd& u) const {
  return assemble_force(*parts_, {law, 0}, u);
}

Eigen::VectorXd MeridianBody::internal_force(const Material& material, const Eigen::VectorXd& u) const {
  return with_linear(*parts_, material, [&](const ElementLaw& law) { return assemble_force(*parts_, law, u); });
}

std::vector<StressPoint> MeridianBody::stress(const GradientLaw& law, const Eigen::VectorXd& u) const {
  return collect_stress(*parts_, {law, 0}, u, true);
}

std::vector<StressPoint> MeridianBody::stress(const Material& material, const Eigen::VectorXd& u) const {
  return with_linear(*parts_, material, [&](const ElementLaw& law) { return collect_stress(*parts_, law, u, false); });
}

std::vector<GradientPoint> MeridianBody::gradients(const Eigen::VectorXd& u) const {
  std::vector<GradientPoint> result;
  MeridianElement element(*parts_, parts_->discretisation.degree + 1);
  std::vector<global_dof_index> indices(parts_->element.n_dofs_per_cell());
  for (const auto& cell : parts_->dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    element.reinit(cell);
    element.append_gradients(element.local(u, indices), result);
  }
  return result;
}

Eigen::VectorXd MeridianBody::condensed(const Eigen::VectorXd& force) const {
  auto values = to_dealii(force);
  parts_->constraints.condense(values);
  return to_eigen(values);
}

Eigen::VectorXd MeridianBody::distributed(const Eigen::VectorXd& u) const {
  auto values = to_dealii(u);
  parts_->constraints.distribute(values);
  return to_eigen(values);
}

Eigen::VectorXd MeridianBody::lifted(const std::function<Eigen::Vector2d(double, double)>& value) const {
  std::map<global_dof_index, double> held;
  const PairFunction function(value);
  dealii::VectorTools::interpolate_boundary_values(parts_->mapping, parts_->dofs, parts_->held.boundary, function, held,
                                                   mask(parts_->held.radial, parts_->held.axial));
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n_unknowns());
  for (const auto& [index, entry] : held) {
    u[index] = entry;
  }
  return with_hanging(*parts_, u);
}

Eigen::VectorXd MeridianBody::interpolated(const std::function<Eigen::Vector2d(double, double)>& value) const {
  dealii::Vector<double> u(parts_->dofs.n_dofs());
  dealii::VectorTools::interpolate(parts_->mapping, parts_->dofs, PairFunction(value), u);
  return to_eigen(u);
}

Eigen::VectorXd MeridianBody::body_force(const std::function<Eigen::Vector2d(double, double)>& force) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(n_unknowns());
  MeridianElement element(*parts_, parts_->discretisation.degree + 2);
  std::vector<global_dof_index> indices(parts_->element.n_dofs_per_cell());
  for (const auto& cell : parts_->dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    element.reinit(cell);
    const Eigen::VectorXd local = element.body_force(force);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      result[indices[i]] += local[Eigen::Index(i)];
    }
  }
  return result;
}

double MeridianBody::axial_force_on(Boundary boundary, const Eigen::VectorXd& force) const {
  const auto set = dealii::DoFTools::extract_boundary_dofs(parts_->dofs, mask(false, true), {boundary});
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(n_unknowns());
  for (const auto index : set) {
    unit[index] = 1;
  }
  // Virtual work: hanging nodes beside the boundary follow it and hand over their share of the force.
  return with_hanging(*parts_, unit).dot(force);
}

std::vector<FieldPoint> MeridianBody::boundary_points(Boundary boundary, const Eigen::VectorXd& u) const {
  std::map<global_dof_index, FieldPoint> points;
  for (const auto& cell : parts_->dofs.active_cell_iterators()) {
    for (const unsigned f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || cell->face(f)->boundary_id() != boundary) {
        continue;
      }
      for (unsigned v = 0; v < 2; ++v) {
        const auto i_r = cell->face(f)->vertex_dof_index(v, 0);
        const auto i_z = cell->face(f)->vertex_dof_index(v, 1);
        const auto x = cell->face(f)->vertex(v);
        points[i_r] = {x[0], x[1], u[i_r], u[i_z]};
      }
    }
  }
  std::vector<FieldPoint> result;
  for (const auto& entry : points) {
    result.push_back(entry.second);
  }
  std::sort(result.begin(), result.end(),
            [](const FieldPoint& a, const FieldPoint& b) { return a.z != b.z ? a.z < b.z : a.r < b.r; });
  return result;
}

Eigen::Vector2d MeridianBody::error(const Eigen::VectorXd& u,
                                    const std::function<Eigen::Vector2d(double, double)>& value,
                                    const std::function<Gradient(double, double)>& gradient) const {
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  MeridianElement element(*parts_, parts_->discretisation.degree + 3);
  std::vector<global_dof_index> indices(parts_->element.n_dofs_per_cell());
  for (const auto& cell : parts_->dofs.active_cell_iterators()) {
    cell->get_dof_indices(indices);
    element.reinit(cell);
    squares += element.squared_error(element.local(u, indices), value, gradient);
  }
  return squares.cwiseSqrt();
}

} // namespace boba::continuum
