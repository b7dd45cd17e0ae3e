// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/meridian_body.h"

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/sparsity_pattern.h>

namespace boba::continuum {

/// The deal.II side of a MeridianBody. Components: 0 is u_r, 1 is u_z.
struct MeridianBody::Parts {
  Parts(MeridianMesh mesh, Discretisation discretisation, Held held);

  MeridianMesh mesh;
  Discretisation discretisation;
  Held held;
  dealii::FESystem<2> element;
  dealii::MappingQ<2> mapping;
  dealii::DoFHandler<2> dofs;
  /// Hanging nodes alone.
  dealii::AffineConstraints<double> hanging;
  /// Hanging nodes, symmetry and held boundary (all homogeneous).
  dealii::AffineConstraints<double> constraints;
  dealii::SparsityPattern pattern;
};

/// True where the material wants the projected form.
bool is_projected(Formulation formulation, const Material& material);

} // namespace boba::continuum
