// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/octant/octant_element.h"
#include "continuum/octant/octant_mesh.h"
#include "continuum/octant/octant_solver.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>
#include <map>
#include <memory>

namespace boba::continuum {

/// A displacement component that is given: row of the unknown, value.
struct Prescribed {
  dealii::types::global_dof_index row;
  double value;
};

/// The discrete octant: unknowns, stiffness and displacement, distributed over the ranks. Every function is collective.
class OctantSystem {
public:
  using Index = dealii::types::global_dof_index;
  using Vector = dealii::PETScWrappers::MPI::Vector;

  /// Throws std::invalid_argument for a degree other than 1 and 2.
  OctantSystem(const OctantShape& shape, unsigned degree);

  /// The stiffness with hanging nodes and mirrors, nothing else held. Kept until the material or the form changes.
  void assemble(const Material& material, bool projected, Multigrid multigrid);
  /// Solves with the prescribed values (of owned, unconstrained rows) and nodal forces; from the last displacement.
  OctantEffort solve(const std::vector<Prescribed>& prescribed, const Vector& load, double tolerance);
  /// Nodal forces that hold the present displacement (K u): reactions where it is prescribed.
  Vector forces() const;

  Vector zero() const { return Vector(owned, communicator); }
  /// Nodal forces of a body force.
  Vector body_force(const VectorField& force) const;
  /// Integral over the pressed boundary of the function of every vertical unknown there.
  Vector plate_areas() const;
  /// Owned rows of a component on a boundary that neither a mirror nor a hanging node constrains, with their places.
  std::map<Index, dealii::Point<3>> rows_on(OctantBoundary boundary, unsigned component) const;
  /// Smallest distance of nodes along an edge, nearly.
  double finest_spacing() const;
  /// Norms of the error of the displacement and of its gradient.
  Eigen::Vector2d error(const VectorField& value, const GradientField& gradient) const;

  template <class Work> void for_each_owned(Work&& work) const {
    std::vector<Index> indices(element.n_dofs_per_cell());
    for (const auto& cell : dofs.active_cell_iterators()) {
      if (cell->is_locally_owned()) {
        cell->get_dof_indices(indices);
        work(cell, indices);
      }
    }
  }

  MPI_Comm communicator = MPI_COMM_WORLD;
  OctantShape shape;
  OctantMesh mesh;
  dealii::FESystem<3> element;
  dealii::MappingQ<3> mapping;
  dealii::DoFHandler<3> dofs;
  dealii::IndexSet owned, relevant;
  dealii::AffineConstraints<double> constraints;
  /// Displacement, with ghosts.
  Vector u;

private:
  Vector coordinates() const;

  dealii::PETScWrappers::MPI::SparseMatrix matrix_;
  std::unique_ptr<OctantSolver> solver_;
};

} // namespace boba::continuum
