// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/octant/octant_solver.h"

#include "continuum/contact/condensed_contact.h"

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
    for (const auto& [name, value] : {std::pair{"numfunctions", "3"}, {"coarsen_type", "PMIS"}, {"interp_type", "ext+i"},
                                      {"P_max", "4"}, {"truncfactor", "0.3"}, {"strong_threshold", "0.5"}}) {
      set_default(fmt::format("-pc_hypre_boomeramg_{}", name).c_str(), value);
    }
  }
  check_petsc(PCSetFromOptions(preconditioner));
}

/// Frees a PETSc object at the end of a scope.
struct Solver {
  explicit Solver(MPI_Comm communicator) { check_petsc(KSPCreate(communicator, &handle)); }
  ~Solver() { KSPDestroy(&handle); }
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  KSP handle = nullptr;
};

} // namespace

OctantSolver::OctantSolver(Vec coordinates, Multigrid multigrid) : multigrid_(multigrid) {
  check_petsc(VecSetBlockSize(coordinates, 3));
  check_petsc(MatNullSpaceCreateRigidBody(coordinates, &rigid_motions_));
}

OctantSolver::~OctantSolver() { MatNullSpaceDestroy(&rigid_motions_); }

OctantEffort OctantSolver::solve(Mat matrix, Vec x, Vec rhs, double tolerance) const {
  OctantEffort effort;
  dealii::Timer timer;
  check_petsc(MatSetBlockSize(matrix, 3));
  if (multigrid_ == Multigrid::gamg) {
    check_petsc(MatSetNearNullSpace(matrix, rigid_motions_));
  }
  MPI_Comm communicator = MPI_COMM_NULL;
  check_petsc(PetscObjectGetComm(reinterpret_cast<PetscObject>(matrix), &communicator));
  const Solver solver(communicator);
  PC preconditioner = nullptr;
  check_petsc(KSPSetOperators(solver.handle, matrix, matrix));
  check_petsc(KSPSetType(solver.handle, KSPCG));
  check_petsc(KSPSetNormType(solver.handle, KSP_NORM_UNPRECONDITIONED));
  check_petsc(KSPSetTolerances(solver.handle, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, max_iterations));
  check_petsc(KSPSetInitialGuessNonzero(solver.handle, PETSC_TRUE));
  check_petsc(KSPGetPC(solver.handle, &preconditioner));
  choose(preconditioner, multigrid_);
  check_petsc(KSPSetFromOptions(solver.handle));
  check_petsc(KSPSetUp(solver.handle));
  effort.precondition = {timer.wall_time(), timer.cpu_time()};
  timer.restart();
  check_petsc(KSPSolve(solver.handle, rhs, x));
  effort.solve = {timer.wall_time(), timer.cpu_time()};
  KSPConvergedReason reason{};
  PetscInt iterations = 0;
  PetscReal residual = 0, scale = 0;
  check_petsc(KSPGetConvergedReason(solver.handle, &reason));
  check_petsc(KSPGetIterationNumber(solver.handle, &iterations));
  check_petsc(KSPGetResidualNorm(solver.handle, &residual));
  check_petsc(VecNorm(rhs, NORM_2, &scale));
  if (reason < 0) {
    throw NotSettled(fmt::format("conjugate gradients did not settle in {} iterations: residual {:.3e} (goal {:.3e})",
                                 iterations, residual, tolerance * scale));
  }
  effort.iterations = int(iterations);
  return effort;
}

} // namespace boba::continuum
