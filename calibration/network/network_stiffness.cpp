// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/network_stiffness.h"

#include "calibration/network/linear_solve.h"

#include <array>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::calibration {

namespace {

constexpr std::array<std::array<int, 2>, 6> voigt{{{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}};

Eigen::Matrix<double, 6, 1> to_voigt(const Matrix3& stress) {
  Eigen::Matrix<double, 6, 1> column;
  for (int p = 0; p < 6; ++p) {
    column[p] = stress(voigt[p][0], voigt[p][1]);
  }
  return column;
}

/// GMRES with the incomplete factors of the pair matrix, by measurement (bench/calibration): for 20000 nodes it needs
/// 25 to 40 iterations a solve; BiCGStab takes 1.3 times and point-block Jacobi 1.4 times as long, and conjugate
/// gradients, 1.15 times faster, have no right to converge on an operator that is not symmetric.
Solver new_solver(const SolveSettings& settings) {
  Solver solver;
  check(KSPCreate(PETSC_COMM_SELF, solver.address()), "KSPCreate");
  check(KSPSetType(solver, KSPGMRES), "KSPSetType");
  PC preconditioner = nullptr;
  check(KSPGetPC(solver, &preconditioner), "KSPGetPC");
  check(PCSetType(preconditioner, PCILU), "PCSetType");
  check(PCFactorSetShiftType(preconditioner, MAT_SHIFT_NONZERO), "PCFactorSetShiftType");
  check(KSPSetTolerances(solver, settings.relative_tolerance, PETSC_DEFAULT, PETSC_DEFAULT, settings.max_iterations),
        "KSPSetTolerances");
  check(KSPSetInitialGuessNonzero(solver, PETSC_TRUE), "KSPSetInitialGuessNonzero");
  check(KSPSetResidualHistory(solver, nullptr, settings.max_iterations + 1, PETSC_TRUE), "KSPSetResidualHistory");
  check(KSPSetOptionsPrefix(solver, "network_"), "KSPSetOptionsPrefix");
  check(KSPSetFromOptions(solver), "KSPSetFromOptions");
  return solver;
}

/// b = -B^T T a.
void set_right_hand_side(const LinearNetwork& network, const std::vector<double>& affine_tension, Vec b) {
  check(VecSet(b, 0.0), "VecSet");
  double* entries = nullptr;
  check(VecGetArray(b, &entries), "VecGetArray");
  network.add_nodal(affine_tension, entries);
  check(VecRestoreArray(b, &entries), "VecRestoreArray");
  check(VecScale(b, -1.0), "VecScale");
}

/// Stress of the affine field plus the relaxation u.
Eigen::Matrix<double, 6, 1> relaxed_stress(const LinearNetwork& network, const std::vector<double>& affine, Vec u,
                                           double alpha) {
  const double* entries = nullptr;
  check(VecGetArrayRead(u, &entries), "VecGetArrayRead");
  std::vector<double> s = network.stretch(entries);
  check(VecRestoreArrayRead(u, &entries), "VecRestoreArrayRead");
  for (std::size_t b = 0; b < s.size(); ++b) {
    s[b] += affine[b];
  }
  return to_voigt(network.stress(network.tension(s, alpha)));
}

} // namespace

Matrix3 unit_strain(int p) {
  Matrix3 strain = Matrix3::Zero();
  const auto [a, b] = voigt.at(p);
  strain(a, b) = strain(b, a) = a == b ? 1.0 : 0.5;
  return strain;
}

Stiffness affine_stiffness(const LinearNetwork& network, double alpha) {
  Stiffness c;
  for (int q = 0; q < 6; ++q) {
    c.col(q) = to_voigt(network.stress(network.tension(network.affine_stretch(unit_strain(q)), alpha)));
  }
  return c;
}

std::vector<StiffnessSolution> relaxed_stiffness(const LinearNetwork& network, const std::vector<double>& alphas,
                                                 const SolveSettings& settings) {
  if (!network.period()) {
    throw std::invalid_argument("the stiffness of a network needs a periodic box (shape = \"periodic_box\")");
  }
  NetworkOperator op(network);
  const Solver solver = new_solver(settings);
  const int n = 3 * network.n_nodes();
  const Vector b = new_vector(n), residual = new_vector(n);
  std::vector<Vector> u;
  for (int q = 0; q < 6; ++q) {
    u.push_back(new_vector(n));
  }
  std::vector<StiffnessSolution> solutions;
  for (const double alpha : alphas) {
    op.set_alpha(alpha);
    const Matrix assembled = settings.assembled ? op.assembled(alpha) : Matrix();
    check(KSPSetOperators(solver, settings.assembled ? static_cast<Mat>(assembled) : op.matrix(), op.pair_matrix()),
          "KSPSetOperators");
    StiffnessSolution solution;
    solution.alpha = alpha;
    for (int q = 0; q < 6; ++q) {
      const std::vector<double> affine = network.affine_stretch(unit_strain(q));
      set_right_hand_side(network, network.tension(affine, alpha), b);
      solution.iterations +=
          solve_or_throw(solver, b, u[q], fmt::format("stiffness at alpha = {}, unit strain {}", alpha, q));
      solution.stiffness.col(q) = relaxed_stress(network, affine, u[q], alpha);
    }
    solutions.push_back(solution);
  }
  return solutions;
}

} // namespace boba::calibration
