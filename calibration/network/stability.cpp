// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/stability.h"

#include "bpm/grain/random.h"
#include "calibration/network/elastic_constants.h"
#include "calibration/network/linear_solve.h"
#include "calibration/network/network_operator.h"
#include "calibration/network/network_stiffness.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <slepceps.h>
#include <stdexcept>

namespace boba::calibration {

namespace {

using EigenSolver = PetscHandle<EPS, EPSDestroy>;

/// Conjugate gradients on A0, which is symmetric.
Solver a0_solver(const NetworkOperator& op, double tolerance, int max_iterations) {
  Solver solver;
  check(KSPCreate(PETSC_COMM_SELF, solver.address()), "KSPCreate");
  check(KSPSetType(solver, KSPCG), "KSPSetType");
  check(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED), "KSPSetNormType");
  PC preconditioner = nullptr;
  check(KSPGetPC(solver, &preconditioner), "KSPGetPC");
  check(PCSetType(preconditioner, PCILU), "PCSetType");
  check(PCFactorSetShiftType(preconditioner, MAT_SHIFT_NONZERO), "PCFactorSetShiftType");
  check(KSPSetTolerances(solver, tolerance, PETSC_DEFAULT, PETSC_DEFAULT, max_iterations), "KSPSetTolerances");
  check(KSPSetResidualHistory(solver, nullptr, max_iterations + 1, PETSC_TRUE), "KSPSetResidualHistory");
  check(KSPSetOperators(solver, op.matrix(), op.pair_matrix()), "KSPSetOperators");
  return solver;
}

/// A0^-1 A1 as a shell matrix.
struct Quotient {
  const NetworkOperator& op;
  const Solver solver;
  Vector product;

  explicit Quotient(const NetworkOperator& a0)
      : op(a0), solver(a0_solver(a0, 1e-8, 2000)), product(new_vector(3 * a0.network().n_nodes())) {}
};

PetscErrorCode multiply_quotient(Mat matrix, Vec in, Vec out) {
  Quotient* self = nullptr;
  const double* u = nullptr;
  double* f = nullptr;
  PetscCall(MatShellGetContext(matrix, &self));
  const LinearNetwork& network = self->op.network();
  PetscCall(VecGetArrayRead(in, &u));
  PetscCall(VecGetArrayWrite(self->product, &f));
  // A1 u = (A0 + A1) u - A0 u, from the bonds: tensions are linear in alpha.
  const std::vector<double> s = network.stretch(u), t0 = network.tension(s, 0.0);
  std::vector<double> t = network.tension(s, 1.0);
  for (std::size_t b = 0; b < s.size(); ++b) {
    t[b] -= t0[b];
  }
  std::fill_n(f, 3 * network.n_nodes(), 0.0);
  network.add_nodal(t, f);
  PetscCall(VecRestoreArrayWrite(self->product, &f));
  PetscCall(VecRestoreArrayRead(in, &u));
  PetscCall(MatNullSpaceRemove(self->op.null_space(), self->product));
  PetscCall(KSPSolve(self->solver, self->product, out));
  KSPConvergedReason reason{};
  PetscCall(KSPGetConvergedReason(self->solver, &reason));
  return reason > 0 ? 0 : PETSC_ERR_NOT_CONVERGED;
}

struct Mode {
  double value = 0.0;
  std::vector<double> square; // |v_i|^2 per node, sum 1
};

std::vector<double> node_squares(Vec v) {
  const double* entries = nullptr;
  PetscInt length = 0;
  check(VecGetSize(v, &length), "VecGetSize");
  check(VecGetArrayRead(v, &entries), "VecGetArrayRead");
  std::vector<double> square(length / 3);
  double sum = 0.0;
  for (std::size_t i = 0; i < square.size(); ++i) {
    square[i] = Eigen::Map<const Vector3>(entries + 3 * i).squaredNorm();
    sum += square[i];
  }
  check(VecRestoreArrayRead(v, &entries), "VecRestoreArrayRead");
  for (double& value : square) {
    value /= sum;
  }
  return square;
}

Mode extreme_mode(Mat quotient, MatNullSpace null_space, EPSWhich which) {
  EigenSolver eigen;
  check(EPSCreate(PETSC_COMM_SELF, eigen.address()), "EPSCreate");
  check(EPSSetOperators(eigen, quotient, nullptr), "EPSSetOperators");
  check(EPSSetProblemType(eigen, EPS_NHEP), "EPSSetProblemType");
  check(EPSSetWhichEigenpairs(eigen, which), "EPSSetWhichEigenpairs");
  check(EPSSetDimensions(eigen, 1, 40, PETSC_DEFAULT), "EPSSetDimensions");
  check(EPSSetTolerances(eigen, 1e-4, 50), "EPSSetTolerances");
  const Vec* rigid = nullptr;
  PetscInt n_rigid = 0;
  check(MatNullSpaceGetVecs(null_space, nullptr, &n_rigid, &rigid), "MatNullSpaceGetVecs");
  check(EPSSetDeflationSpace(eigen, n_rigid, const_cast<Vec*>(rigid)), "EPSSetDeflationSpace");
  check(EPSSetOptionsPrefix(eigen, "stability_"), "EPSSetOptionsPrefix");
  check(EPSSetFromOptions(eigen), "EPSSetFromOptions");
  check(EPSSolve(eigen), "EPSSolve");
  PetscInt converged = 0, iterations = 0;
  check(EPSGetConverged(eigen, &converged), "EPSGetConverged");
  check(EPSGetIterationNumber(eigen, &iterations), "EPSGetIterationNumber");
  if (converged < 1) {
    throw std::runtime_error(
        fmt::format("stability limit: the eigenvalue solve did not converge in {} restarts", iterations));
  }
  Vector v;
  check(MatCreateVecs(quotient, v.address(), nullptr), "MatCreateVecs");
  Mode mode;
  check(EPSGetEigenpair(eigen, 0, &mode.value, nullptr, v, nullptr), "EPSGetEigenpair");
  mode.square = node_squares(v);
  return mode;
}

StabilityLimit limit(const LinearNetwork& network, EPSWhich which) {
  NetworkOperator op(network);
  op.set_alpha(0.0);
  Quotient quotient(op);
  const int n = 3 * network.n_nodes();
  Matrix shell;
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, &quotient, shell.address()), "MatCreateShell");
  check(MatShellSetOperation(shell, MATOP_MULT, reinterpret_cast<void (*)()>(multiply_quotient)),
        "MatShellSetOperation");
  const Mode mode = extreme_mode(shell, op.null_space(), which);
  const bool lower = which == EPS_LARGEST_REAL;
  if (lower ? mode.value <= 0.0 : mode.value >= 0.0) {
    return {.alpha = (lower ? -1.0 : 1.0) * std::numeric_limits<double>::infinity()};
  }
  double fourth = 0.0;
  for (const double square : mode.square) {
    fourth += square * square;
  }
  const auto top = std::max_element(mode.square.begin(), mode.square.end());
  return {.alpha = -1.0 / mode.value,
          .node = static_cast<int>(top - mode.square.begin()),
          .participation = 1.0 / (fourth * network.n_nodes())};
}

} // namespace

void require_rigid(const LinearNetwork& network) {
  NetworkOperator op(network);
  op.set_alpha(0.0);
  const int n = 3 * network.n_nodes();
  const Vector f = new_vector(n), u = new_vector(n);
  Random random(1);
  double* entries = nullptr;
  check(VecGetArrayWrite(f, &entries), "VecGetArrayWrite");
  for (int i = 0; i < n; ++i) {
    entries[i] = random.uniform(-1.0, 1.0);
  }
  check(VecRestoreArrayWrite(f, &entries), "VecRestoreArrayWrite");
  check(MatNullSpaceRemove(op.null_space(), f), "MatNullSpaceRemove");
  const Solver solver = a0_solver(op, 1e-6, 1000);
  try {
    solve_or_throw(solver, f, u, "rigidity");
  } catch (const std::runtime_error&) {
    const std::vector<double> square = node_squares(u);
    const int node = static_cast<int>(std::max_element(square.begin(), square.end()) - square.begin());
    const Vector3& x = network.position()[node];
    throw std::invalid_argument(fmt::format(
        "the network is not rigid: a mechanism moves nodes without stretching a bond, node {} at ({:.4g}, {:.4g}, "
        "{:.4g}) most; last residuals: {}",
        node, x.x(), x.y(), x.z(), residual_history_end(solver)));
  }
}

StabilityLimit lower_stability_limit(const LinearNetwork& network) {
  return limit(network, EPS_LARGEST_REAL);
}
StabilityLimit upper_stability_limit(const LinearNetwork& network) {
  return limit(network, EPS_SMALLEST_REAL);
}

double affine_shear_limit(const LinearNetwork& network) {
  const double g0 = isotropic_part(affine_stiffness(network, 0.0)).shear;
  const double g1 = isotropic_part(affine_stiffness(network, 1.0)).shear - g0;
  return -g0 / g1;
}

} // namespace boba::calibration
