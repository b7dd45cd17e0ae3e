// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/octant/octant_solver.h"

#include "continuum/contact/condensed_contact.h"

#include <algorithm>
#include <cmath>
#include <deal.II/base/timer.h>
#include <fmt/format.h>
#include <stdexcept>
#include <string>
#include <utility>

namespace boba::continuum {
namespace {

constexpr int max_iterations = 2000;

void check_petsc(PetscErrorCode code) {
  if (code != 0) {
    throw std::runtime_error(fmt::format("PETSc failed with error {}", code));
  }
}

/// An option of the preconditioner, unless the user set it through PETSC_OPTIONS.
void set_default(const char* name, const char* value) {
  PetscBool present = PETSC_FALSE;
  check_petsc(PetscOptionsHasName(nullptr, nullptr, name, &present));
  if (present == PETSC_FALSE) {
    check_petsc(PetscOptionsSetValue(nullptr, name, value));
  }
}

/// Options of each multigrid; measurements behind them: docs/performance-continuum.md.
void choose(PC preconditioner, Multigrid multigrid) {
  if (multigrid == Multigrid::gamg) {
    check_petsc(PCSetType(preconditioner, PCGAMG));
    // Unlike relaxation in the order of the unknowns, Jacobi's does not depend on how the ranks share them.
    set_default("-mg_levels_pc_type", "jacobi");
  } else {
    check_petsc(PCSetType(preconditioner, PCHYPRE));
    check_petsc(PCHYPRESetType(preconditioner, "boomeramg"));
    // Each component is coarsened on its own: without that the iterations grow with refinement. The classical coarse
    // levels fill up in three dimensions; these stay sparse.
    for (const auto& [name, value] : {std::pair{"numfunctions", "3"},
                                      {"coarsen_type", "PMIS"},
                                      {"interp_type", "ext+i"},
                                      {"P_max", "4"},
                                      {"truncfactor", "0.3"},
                                      {"strong_threshold", "0.5"}}) {
      set_default(fmt::format("-pc_hypre_boomeramg_{}", name).c_str(), value);
    }
  }
  check_petsc(PCSetFromOptions(preconditioner));
}

} // namespace

OctantSolver::OctantSolver(Vec coordinates, Multigrid multigrid) : multigrid_(multigrid) {
  MPI_Comm communicator = MPI_COMM_NULL;
  check_petsc(PetscObjectGetComm(reinterpret_cast<PetscObject>(coordinates), &communicator));
  check_petsc(VecSetBlockSize(coordinates, 3));
  check_petsc(MatNullSpaceCreateRigidBody(coordinates, &rigid_motions_));
  check_petsc(KSPCreate(communicator, &solver_));
  check_petsc(KSPSetType(solver_, KSPCG));
  check_petsc(KSPSetNormType(solver_, KSP_NORM_UNPRECONDITIONED));
  check_petsc(KSPSetInitialGuessNonzero(solver_, PETSC_TRUE));
  PC preconditioner = nullptr;
  check_petsc(KSPGetPC(solver_, &preconditioner));
  choose(preconditioner, multigrid_);
  check_petsc(KSPSetFromOptions(solver_));
}

OctantSolver::~OctantSolver() {
  KSPDestroy(&solver_);
  MatNullSpaceDestroy(&rigid_motions_);
}

OctantEffort OctantSolver::solve(Mat matrix, Vec x, Vec rhs, double tolerance) {
  OctantEffort effort;
  dealii::Timer timer;
  check_petsc(MatSetBlockSize(matrix, 3));
  if (multigrid_ == Multigrid::gamg) {
    check_petsc(MatSetNearNullSpace(matrix, rigid_motions_));
  }
  check_petsc(KSPSetOperators(solver_, matrix, matrix));
  check_petsc(KSPSetTolerances(solver_, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, max_iterations));
  check_petsc(KSPSetReusePreconditioner(solver_, first_rate_ > 0 ? PETSC_TRUE : PETSC_FALSE));
  check_petsc(KSPSetUp(solver_));
  effort.precondition = {timer.wall_time(), timer.cpu_time()};
  timer.restart();
  Vec start = nullptr;
  PetscReal first = 0, last = 0, scale = 0;
  check_petsc(VecDuplicate(rhs, &start));
  check_petsc(MatMult(matrix, x, start));
  check_petsc(VecAYPX(start, -1, rhs));
  check_petsc(VecNorm(start, NORM_2, &first));
  check_petsc(VecDestroy(&start));
  check_petsc(KSPSolve(solver_, rhs, x));
  effort.solve = {timer.wall_time(), timer.cpu_time()};
  KSPConvergedReason reason{};
  PetscInt iterations = 0;
  check_petsc(KSPGetConvergedReason(solver_, &reason));
  check_petsc(KSPGetIterationNumber(solver_, &iterations));
  check_petsc(KSPGetResidualNorm(solver_, &last));
  check_petsc(VecNorm(rhs, NORM_2, &scale));
  if (reason < 0) {
    throw NotSettled(fmt::format("conjugate gradients did not settle in {} iterations: residual {:.3e} (goal {:.3e})",
                                 iterations, last, tolerance * scale));
  }
  effort.iterations = int(iterations);
  const double rate = iterations / std::max(0.5, std::log10(first / std::max(last, 1e-300)));
  first_rate_ = first_rate_ > 0 && rate > 2 * first_rate_ ? 0 : first_rate_ > 0 ? first_rate_ : std::max(rate, 1e-3);
  return effort;
}

} // namespace boba::continuum
