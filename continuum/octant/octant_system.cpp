// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/octant/octant_system.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::continuum {
namespace {

using Vector = OctantSystem::Vector;
using Index = OctantSystem::Index;

dealii::ComponentMask only(unsigned component) {
  dealii::ComponentMask mask(3, false);
  mask.set(component, true);
  return mask;
}

unsigned checked(unsigned degree) {
  if (degree < 1 || degree > 2) {
    throw std::invalid_argument(
        fmt::format("degree = {} is not allowed in three dimensions: it must be 1 or 2", degree));
  }
  return degree;
}

} // namespace

OctantSystem::OctantSystem(const OctantShape& given, unsigned degree)
    : shape(given), mesh(communicator), element(dealii::FE_Q<3>(checked(degree)), 3), mapping(degree), dofs(mesh) {
  make_octant(mesh, shape);
  dofs.distribute_dofs(element);
  owned = dofs.locally_owned_dofs();
  dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
  constraints.reinit(relevant);
  dealii::DoFTools::make_hanging_node_constraints(dofs, constraints);
  for (const unsigned k : {0u, 1u, 2u}) {
    dealii::DoFTools::make_zero_boundary_constraints(dofs, k, constraints, only(k));
  }
  constraints.close();
  u.reinit(owned, relevant, communicator);
}

void OctantSystem::assemble(const Material& material, bool projected, Multigrid multigrid) {
  dealii::DynamicSparsityPattern pattern(relevant);
  dealii::DoFTools::make_sparsity_pattern(dofs, pattern, constraints, false);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, owned, communicator, relevant);
  matrix_.clear();
  matrix_.reinit(owned, owned, pattern, communicator);
  OctantElement cell_element(mapping, element, element.degree + 1);
  const unsigned n = element.n_dofs_per_cell();
  dealii::FullMatrix<double> local(n, n);
  for_each_owned([&](const auto& cell, const std::vector<Index>& indices) {
    cell_element.reinit(cell);
    const Eigen::MatrixXd k = cell_element.stiffness(material, projected);
    std::copy(k.data(), k.data() + k.size(), &local(0, 0)); // symmetric: the order of the entries is the same
    constraints.distribute_local_to_global(local, indices, matrix_);
  });
  matrix_.compress(dealii::VectorOperation::add);
  solver_ = std::make_unique<OctantSolver>(coordinates(), multigrid);
}

Vector OctantSystem::coordinates() const {
  std::map<Index, dealii::Point<3>> places;
  dealii::DoFTools::map_dofs_to_support_points(mapping, dofs, places);
  Vector result = zero();
  Index component = 0; // the unknowns of a node follow each other
  for (const auto row : owned) {
    result[row] = places.at(row)[unsigned(component++ % 3)];
  }
  result.compress(dealii::VectorOperation::insert);
  return result;
}

OctantEffort OctantSystem::solve(const std::vector<Prescribed>& prescribed, const Vector& load, double tolerance) {
  Vector x = zero(), rhs = load;
  x = u;
  constraints.set_zero(x);
  std::vector<PetscInt> rows;
  for (const auto& [row, value] : prescribed) {
    rows.push_back(PetscInt(row));
    x[row] = value;
  }
  x.compress(dealii::VectorOperation::insert);
  Mat held = nullptr;
  MatDuplicate(matrix_, MAT_COPY_VALUES, &held);
  // Zero rows and columns leave the matrix symmetric; their diagonal is of the size of the others.
  const double diagonal = matrix_.diag_element(owned.nth_index_in_set(0));
  MatZeroRowsColumns(held, PetscInt(rows.size()), rows.data(), diagonal, x, rhs);
  OctantEffort effort;
  try {
    effort = solver_->solve(held, x, rhs, tolerance);
  } catch (...) {
    MatDestroy(&held);
    throw;
  }
  MatDestroy(&held);
  constraints.distribute(x);
  u = x;
  return effort;
}

Vector OctantSystem::forces() const {
  Vector x = zero(), result = zero();
  x = u;
  constraints.set_zero(x);
  matrix_.vmult(result, x);
  return result;
}

Vector OctantSystem::body_force(const VectorField& force) const {
  Vector result = zero();
  OctantElement cell_element(mapping, element, element.degree + 2);
  dealii::Vector<double> local(element.n_dofs_per_cell());
  for_each_owned([&](const auto& cell, const std::vector<Index>& indices) {
    cell_element.reinit(cell);
    const Eigen::VectorXd values = cell_element.body_force(force);
    std::copy(values.data(), values.data() + values.size(), local.begin());
    constraints.distribute_local_to_global(local, indices, result);
  });
  result.compress(dealii::VectorOperation::add);
  return result;
}

Vector OctantSystem::plate_areas() const {
  Vector result = zero();
  dealii::FEFaceValues<3> values(mapping, element.base_element(0), dealii::QGauss<2>(element.degree + 2),
                                 dealii::update_values | dealii::update_JxW_values);
  dealii::Vector<double> local(element.n_dofs_per_cell());
  for_each_owned([&](const auto& cell, const std::vector<Index>& indices) {
    for (const unsigned f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || cell->face(f)->boundary_id() != octant_plate_side) {
        continue;
      }
      values.reinit(typename dealii::Triangulation<3>::cell_iterator(cell), f);
      local = 0;
      for (unsigned k = 0; k < values.dofs_per_cell; ++k) {
        for (const unsigned q : values.quadrature_point_indices()) {
          local[element.component_to_system_index(2, k)] += values.shape_value(k, q) * values.JxW(q);
        }
      }
      constraints.distribute_local_to_global(local, indices, result);
    }
  });
  result.compress(dealii::VectorOperation::add);
  return result;
}

std::map<Index, dealii::Point<3>> OctantSystem::rows_on(OctantBoundary boundary, unsigned component) const {
  std::map<Index, dealii::Point<3>> places, result;
  dealii::DoFTools::map_dofs_to_support_points(mapping, dofs, places, only(component));
  for (const auto row : dealii::DoFTools::extract_boundary_dofs(dofs, only(component), {boundary})) {
    if (owned.is_element(row) && !constraints.is_constrained(row)) {
      result[row] = places.at(row);
    }
  }
  return result;
}

double OctantSystem::finest_spacing() const {
  return dealii::GridTools::minimal_cell_diameter(mesh) / std::sqrt(3.) / element.degree;
}

Eigen::Vector2d OctantSystem::error(const VectorField& value, const GradientField& gradient) const {
  Eigen::Vector2d squares = Eigen::Vector2d::Zero();
  OctantElement cell_element(mapping, element, element.degree + 3);
  Eigen::VectorXd local(element.n_dofs_per_cell());
  for_each_owned([&](const auto& cell, const std::vector<Index>& indices) {
    cell_element.reinit(cell);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      local[Eigen::Index(i)] = u[indices[i]];
    }
    squares += cell_element.squared_error(local, value, gradient);
  });
  return {std::sqrt(dealii::Utilities::MPI::sum(squares[0], communicator)),
          std::sqrt(dealii::Utilities::MPI::sum(squares[1], communicator))};
}

} // namespace boba::continuum
