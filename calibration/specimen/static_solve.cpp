// SPDX-License-Identifier: GPL-3.0-or-later
// The static solver of NonlinearNetwork: Newton's method by PETSc's SNES, matrix-free with the analytic Jacobian.
#include "calibration/specimen/nonlinear_network.h"
#include "calibration/specimen/rigid_motions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <petscsnes.h>
#include <stdexcept>

namespace boba::calibration {

namespace {

using NewtonSolver = PetscHandle<SNES, SNESDestroy>;

constexpr double contact_margin = NonlinearNetwork::contact_margin;
constexpr int most_lists = 20; // of contacts, in one relaxation
// Of a Newton step's residual that its linear solve leaves: contacts stiffen so fast that a step gains a factor of four
// at first, whatever the linear solve does.
constexpr double linear_share = 1e-2;
constexpr int most_creeps = 6, creep_steps = 1200, steps_a_list = 20;

} // namespace

/// What PETSc calls back.
struct SnesGlue {
  NonlinearNetwork& network;
  Mat pair_matrix;
  RigidMotions rigid;

  std::vector<Vector3> positions(Vec displacement) const {
    const double* u = nullptr;
    check(VecGetArrayRead(displacement, &u), "VecGetArrayRead");
    std::vector<Vector3> x = network.position_;
    for (int n = 0; n < network.n_nodes(); ++n) {
      x[n] += Eigen::Map<const Vector3>(u + 3 * n);
    }
    check(VecRestoreArrayRead(displacement, &u), "VecRestoreArrayRead");
    return x;
  }

  void write(const std::vector<Vector3>& values, double sign, Vec held_values, Vec out) const {
    double* entries = nullptr;
    const double* held = nullptr;
    check(VecGetArrayWrite(out, &entries), "VecGetArrayWrite");
    check(VecGetArrayRead(held_values, &held), "VecGetArrayRead");
    for (int n = 0; n < network.n_nodes(); ++n) {
      for (int c = 0; c < 3; ++c) {
        entries[3 * n + c] = network.held_[n][c] ? held[3 * n + c] : sign * values[n][c];
      }
    }
    check(VecRestoreArrayRead(held_values, &held), "VecRestoreArrayRead");
    check(VecRestoreArrayWrite(out, &entries), "VecRestoreArrayWrite");
  }

  static PetscErrorCode residual(SNES, Vec displacement, Vec out, void* context) {
    const auto* self = static_cast<const SnesGlue*>(context);
    std::vector<Vector3> forces = self->network.forces(self->positions(displacement));
    self->rigid.take_out(forces);
    self->write(forces, -1.0, displacement, out);
    return 0;
  }

  static PetscErrorCode jacobian(SNES, Vec displacement, Mat, Mat pair, void* context) {
    auto* self = static_cast<SnesGlue*>(context);
    self->network.linearise(self->positions(displacement));
    self->network.fill_pair_matrix(pair);
    return 0;
  }

  static PetscErrorCode multiply(Mat matrix, Vec in, Vec out) {
    SnesGlue* self = nullptr;
    PetscCall(MatShellGetContext(matrix, &self));
    std::vector<Vector3> u(self->network.n_nodes());
    const double* entries = nullptr;
    PetscCall(VecGetArrayRead(in, &entries));
    for (int n = 0; n < self->network.n_nodes(); ++n) {
      for (int c = 0; c < 3; ++c) {
        u[n][c] = self->network.held_[n][c] ? 0.0 : entries[3 * n + c];
      }
    }
    PetscCall(VecRestoreArrayRead(in, &entries));
    // On the rigid motions, which no force answers, the operator is minus the identity.
    const std::vector<Vector3> whole = u;
    self->rigid.take_out(u);
    std::vector<Vector3> derivative = self->network.force_derivative(u);
    self->rigid.take_out(derivative);
    for (std::size_t n = 0; n < u.size(); ++n) {
      derivative[n] -= whole[n] - u[n];
    }
    self->write(derivative, -1.0, in, out);
    return 0;
  }
};

namespace {

Matrix empty_pair_matrix(int n_nodes, const std::vector<int>& blocks_in_row) {
  Matrix matrix;
  check(MatCreateSeqBAIJ(PETSC_COMM_SELF, 3, 3 * n_nodes, 3 * n_nodes, 0, blocks_in_row.data(), matrix.address()),
        "MatCreateSeqBAIJ");
  check(MatSetOption(matrix, MAT_ROW_ORIENTED, PETSC_FALSE), "MatSetOption");
  return matrix;
}

NullSpace translations(Vec like) {
  std::array<Vector, 3> direction;
  std::array<Vec, 3> raw{};
  for (int c = 0; c < 3; ++c) {
    check(VecDuplicate(like, direction[c].address()), "VecDuplicate");
    check(VecStrideSet(direction[c], c, 1.0), "VecStrideSet");
    check(VecNormalize(direction[c], nullptr), "VecNormalize");
    raw[c] = direction[c];
  }
  NullSpace space;
  check(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE, 3, raw.data(), space.address()), "MatNullSpaceCreate");
  return space;
}

void configure(SNES newton, double tolerance) {
  check(SNESSetType(newton, SNESNEWTONLS), "SNESSetType");
  check(SNESSetTolerances(newton, tolerance, 0.0, 0.0, 60, 10000), "SNESSetTolerances");
  KSP linear = nullptr;
  PC preconditioner = nullptr;
  check(SNESGetKSP(newton, &linear), "SNESGetKSP");
  check(KSPSetType(linear, KSPGMRES), "KSPSetType");
  check(KSPGMRESSetRestart(linear, 60), "KSPGMRESSetRestart");
  check(KSPSetTolerances(linear, linear_share, PETSC_DEFAULT, PETSC_DEFAULT, 2000), "KSPSetTolerances");
  check(KSPGetPC(linear, &preconditioner), "KSPGetPC");
  check(PCSetType(preconditioner, PCILU), "PCSetType");
  check(PCFactorSetShiftType(preconditioner, MAT_SHIFT_NONZERO), "PCFactorSetShiftType");
  check(SNESSetConvergenceHistory(newton, nullptr, nullptr, 100, PETSC_TRUE), "SNESSetConvergenceHistory");
  check(SNESSetOptionsPrefix(newton, "specimen_"), "SNESSetOptionsPrefix");
  check(SNESSetFromOptions(newton), "SNESSetFromOptions");
}

void require_convergence(SNES newton) {
  SNESConvergedReason reason{};
  check(SNESGetConvergedReason(newton, &reason), "SNESGetConvergedReason");
  if (reason > 0) {
    return;
  }
  PetscReal* history = nullptr;
  PetscInt length = 0;
  check(SNESGetConvergenceHistory(newton, &history, nullptr, &length), "SNESGetConvergenceHistory");
  std::string end;
  for (PetscInt n = std::max<PetscInt>(0, length - 5); n < length; ++n) {
    end += fmt::format("{}{:.3e}", end.empty() ? "" : ", ", history[n]);
  }
  throw std::runtime_error(
      fmt::format("the static solve did not converge ({}); last residuals: {}", SNESConvergedReasons[reason], end));
}

} // namespace

void NonlinearNetwork::creep(int steps) {
  constexpr double dt = 0.1, drag = 0.05; // tau; 1/tau, critical for waves of the length of a grain
  const RigidMotions rigid(position_, steady_, n_bodies_);
  std::vector<Vector3> velocity(position_.size(), Vector3::Zero());
  for (int s = 0; s < steps; ++s) {
    if (s % steps_a_list == 0) {
      find_contacts();
    }
    std::vector<Vector3> force = forces(position_);
    for (std::size_t n = 0; n < force.size(); ++n) {
      for (int c = 0; c < 3; ++c) {
        force[n][c] = held_[n][c] ? 0.0 : force[n][c];
      }
    }
    rigid.take_out(force);
    for (std::size_t n = 0; n < force.size(); ++n) {
      velocity[n] = (1.0 - drag * dt) * velocity[n] + dt * force[n];
      position_[n] += dt * velocity[n];
    }
  }
}

void NonlinearNetwork::relax(double tolerance) {
  int creeps = 0;
  for (int list = 0; list < most_lists; ++list) {
    find_contacts();
    const std::vector<Vector3> before = position_;
    try {
      newton(tolerance);
    } catch (const std::runtime_error&) {
      if (++creeps > most_creeps) {
        throw;
      }
      position_ = before;
      creep(creep_steps);
      ++n_creeps_;
      continue;
    }
    const auto still_valid = [](const Vector3& a, const Vector3& b) { return (a - b).norm() < 0.5 * contact_margin; };
    if (std::equal(before.begin(), before.end(), position_.begin(), still_valid)) {
      return;
    }
  }
  throw std::runtime_error("the static solve moves nodes too far for its list of contacts; take smaller steps");
}

void NonlinearNetwork::newton(double tolerance) {
  std::vector<int> blocks_in_row(n_nodes(), 1);
  for (const Link& link : links_) {
    ++blocks_in_row[link.i];
    ++blocks_in_row[link.j];
  }
  const Matrix pair = empty_pair_matrix(n_nodes(), blocks_in_row);
  SnesGlue glue{*this, pair, RigidMotions(position_, steady_, n_bodies_)};
  const int n = 3 * n_nodes();
  Matrix shell;
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, &glue, shell.address()), "MatCreateShell");
  check(MatShellSetOperation(shell, MATOP_MULT, reinterpret_cast<void (*)()>(SnesGlue::multiply)),
        "MatShellSetOperation");
  Vector u, r;
  check(VecCreateSeq(PETSC_COMM_SELF, n, u.address()), "VecCreateSeq");
  check(VecSetBlockSize(u, 3), "VecSetBlockSize");
  check(VecDuplicate(u, r.address()), "VecDuplicate");
  if (period_ && !steady_[0]) {
    const NullSpace space = translations(u);
    check(MatSetNullSpace(shell, space), "MatSetNullSpace");
    check(MatSetTransposeNullSpace(shell, space), "MatSetTransposeNullSpace");
  }
  NewtonSolver newton;
  check(SNESCreate(PETSC_COMM_SELF, newton.address()), "SNESCreate");
  check(SNESSetFunction(newton, r, SnesGlue::residual, &glue), "SNESSetFunction");
  check(SNESSetJacobian(newton, shell, pair, SnesGlue::jacobian, &glue), "SNESSetJacobian");
  configure(newton, tolerance * std::sqrt(static_cast<double>(n)));
  check(SNESSolve(newton, nullptr, u), "SNESSolve");
  require_convergence(newton);
  position_ = glue.positions(u);
  linearised_.clear();
  wall_spring_.clear();
}

} // namespace boba::calibration
