// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/octant/duration.h"
#include "continuum/octant/multigrid.h"

#include <petscksp.h>

namespace boba::continuum {

/// What one solution took.
struct OctantEffort {
  int iterations = 0;
  Duration precondition, solve;
};

/// Conjugate gradients with algebraic multigrid.
class OctantSolver {
public:
  /// coordinates: place of the node of every unknown, three a node, distributed like the rows of the matrices.
  OctantSolver(Vec coordinates, Multigrid multigrid);
  ~OctantSolver();
  OctantSolver(const OctantSolver&) = delete;
  OctantSolver& operator=(const OctantSolver&) = delete;

  /// Solves matrix x = rhs from the present x to |residual| <= tolerance |rhs|. The multigrid of the first matrix is
  /// kept for the next ones, which hold a few other unknowns, until it takes twice as many iterations.
  /// Throws NotSettled with the last residual.
  OctantEffort solve(Mat matrix, Vec x, Vec rhs, double tolerance);

private:
  Multigrid multigrid_;
  MatNullSpace rigid_motions_ = nullptr;
  KSP solver_ = nullptr;
  /// Iterations an order of magnitude of the residual took when the multigrid was new; 0: there is none.
  double first_rate_ = 0;
};

} // namespace boba::continuum
