// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/specimen/nonlinear_network.h"

#include "bpm/grain/near_pairs.h"
#include "bpm/laws/bond.h"
#include "bpm/laws/contact.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <petscsnes.h>
#include <stdexcept>

namespace boba::calibration {

namespace {

using NewtonSolver = PetscHandle<SNES, SNESDestroy>;

constexpr double stabilising_share = 0.2; // of the elastic spring, taken off across a bond in compression at most
constexpr double contact_margin = 0.3;    // d; pairs closer than d + margin are watched during a solve
constexpr double k3 = 50.0;               // k/d^2, the engine's default
constexpr int most_lists = 10;

} // namespace

NonlinearNetwork::NonlinearNetwork(const GrainTemplate& grain, double alpha)
    : alpha_(alpha), reference_(grain.position), position_(grain.position), period_(grain.period),
      volume0_(reference_node_volumes(grain.n_nodes(), grain.bonds)), held_(grain.n_nodes(), 0) {
  for (const Bond& bond : grain.bonds) {
    Vector3 cells = Vector3::Zero();
    if (period_) {
      cells = (position_[bond.i] - position_[bond.j]).cwiseQuotient(*period_).array().round();
    }
    links_.push_back({bond.i, bond.j, cells, bond.r0, 1.0 / (volume0_[bond.i] + volume0_[bond.j])});
  }
  n_bonds_ = links_.size();
}

void NonlinearNetwork::hold(const std::vector<int>& nodes) {
  for (const int node : nodes) {
    held_.at(node) = 1;
  }
}

void NonlinearNetwork::deform_cell(const Matrix3& deformation) {
  const Matrix3 change = deformation * deformation_.inverse();
  for (Vector3& x : position_) {
    x = change * x;
  }
  deformation_ = deformation;
}

Matrix3 NonlinearNetwork::cell() const {
  return period_ ? Matrix3(deformation_ * period_->asDiagonal()) : Matrix3(Matrix3::Zero());
}

std::vector<NonlinearNetwork::State> NonlinearNetwork::states(const std::vector<Vector3>& position) const {
  const Matrix3 h = cell();
  std::vector<State> states(links_.size());
  std::vector<double> volume(position.size(), 0.0);
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Link& link = links_[b];
    const Vector3 difference = position[link.i] - position[link.j] - h * link.cells;
    states[b].r = difference.norm();
    states[b].e = difference / states[b].r;
    if (b < n_bonds_) {
      const double cube = states[b].r * states[b].r * states[b].r;
      volume[link.i] += cube;
      volume[link.j] += cube;
    }
  }
  for (std::size_t b = 0; b < n_bonds_; ++b) {
    const Link& link = links_[b];
    const double root = std::cbrt((volume[link.i] + volume[link.j]) * link.inverse_volume);
    states[b].force = bond_force(1.0, alpha_, 0.0, states[b].r, link.r0, 1.0 / link.r0, root, 0.0);
    states[b].many_body = alpha_ * link.inverse_volume / (root * root);
    states[b].spring = 1.0 + alpha_ / link.r0;
  }
  for (std::size_t b = n_bonds_; b < links_.size(); ++b) {
    const double r = states[b].r, overlap = std::max(0.0, 1.0 - r);
    states[b].force = r < 1.0 ? contact_force(1.0, k3, 0.0, 1.0, r, 0.0) : 0.0;
    states[b].many_body = 0.0;
    states[b].spring = r < 1.0 ? 1.0 + 3.0 * k3 * overlap * overlap : 0.0;
  }
  return states;
}

std::vector<Vector3> NonlinearNetwork::forces(const std::vector<Vector3>& position) const {
  std::vector<Vector3> force(position.size(), Vector3::Zero());
  const std::vector<State> bonds = states(position);
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Vector3 f = bonds[b].force * bonds[b].e;
    force[links_[b].i] += f;
    force[links_[b].j] -= f;
  }
  return force;
}

std::vector<Vector3> NonlinearNetwork::force_derivative(const std::vector<Vector3>& displacement) const {
  std::vector<State> fresh;
  if (linearised_.empty()) {
    fresh = states(position_);
  }
  const std::vector<State>& bonds = linearised_.empty() ? fresh : linearised_;
  std::vector<double> sum(position_.size(), 0.0), stretch(links_.size());
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Link& link = links_[b];
    stretch[b] = bonds[b].e.dot(displacement[link.i] - displacement[link.j]);
    if (b < n_bonds_) {
      const double share = bonds[b].r * bonds[b].r * stretch[b];
      sum[link.i] += share;
      sum[link.j] += share;
    }
  }
  std::vector<Vector3> derivative(position_.size(), Vector3::Zero());
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Link& link = links_[b];
    const State& bond = bonds[b];
    const double along = bond.many_body * (sum[link.i] + sum[link.j]) - bond.spring * stretch[b];
    const Vector3 turned = displacement[link.i] - displacement[link.j] - stretch[b] * bond.e;
    const Vector3 f = along * bond.e + bond.force / bond.r * turned;
    derivative[link.i] += f;
    derivative[link.j] -= f;
  }
  return derivative;
}

Matrix3 NonlinearNetwork::stress() const {
  Matrix3 sum = Matrix3::Zero();
  for (const State& bond : states(position_)) {
    sum -= bond.force * bond.r * bond.e * bond.e.transpose();
  }
  return sum / (deformation_.determinant() * period_.value_or(Vector3::Ones()).prod());
}

void NonlinearNetwork::fill_pair_matrix(Mat matrix) const {
  check(MatZeroEntries(matrix), "MatZeroEntries");
  for (std::size_t b = 0; b < links_.size(); ++b) {
    const Link& link = links_[b];
    const State& bond = linearised_[b];
    const double spring = b < n_bonds_ ? 1.0 + std::max(alpha_, -0.7) / link.r0 : bond.spring;
    const double across = std::max(-bond.force / bond.r, -stabilising_share * spring);
    const Matrix3 along = bond.e * bond.e.transpose();
    const Matrix3 block = spring * along + across * (Matrix3::Identity() - along), minus = -block;
    const PetscInt i = link.i, j = link.j;
    const bool i_free = !held_[i], j_free = !held_[j];
    if (i_free) {
      check(MatSetValuesBlocked(matrix, 1, &i, 1, &i, block.data(), ADD_VALUES), "MatSetValuesBlocked");
    }
    if (j_free) {
      check(MatSetValuesBlocked(matrix, 1, &j, 1, &j, block.data(), ADD_VALUES), "MatSetValuesBlocked");
    }
    const Matrix3 coupling = i_free && j_free ? minus : Matrix3(Matrix3::Zero());
    check(MatSetValuesBlocked(matrix, 1, &i, 1, &j, coupling.data(), ADD_VALUES), "MatSetValuesBlocked");
    check(MatSetValuesBlocked(matrix, 1, &j, 1, &i, coupling.data(), ADD_VALUES), "MatSetValuesBlocked");
  }
  const Matrix3 identity = Matrix3::Identity();
  for (PetscInt n = 0; n < n_nodes(); ++n) {
    if (held_[n]) {
      check(MatSetValuesBlocked(matrix, 1, &n, 1, &n, identity.data(), ADD_VALUES), "MatSetValuesBlocked");
    }
  }
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
}

void NonlinearNetwork::find_contacts() {
  links_.resize(n_bonds_);
  // The search knows cuboids; the cells of these specimens keep their axes.
  std::optional<Vector3> period;
  std::vector<Vector3> position = position_;
  if (period_) {
    period = cell().diagonal();
    for (Vector3& x : position) {
      x = wrapped(x, *period);
    }
  }
  const auto bonded = [&](const NearPair& pair) {
    const auto at = std::lower_bound(
        links_.begin(), links_.begin() + static_cast<std::ptrdiff_t>(n_bonds_), pair,
        [](const Link& link, const NearPair& p) { return std::pair(link.i, link.j) < std::pair(p.i, p.j); });
    return at != links_.begin() + static_cast<std::ptrdiff_t>(n_bonds_) && at->i == pair.i && at->j == pair.j;
  };
  for (const NearPair& pair : near_pairs(position, 1.0 + contact_margin, period)) {
    if (!bonded(pair)) {
      Vector3 cells = Vector3::Zero();
      if (period) {
        cells = (position_[pair.i] - position_[pair.j]).cwiseQuotient(*period).array().round();
      }
      links_.push_back({pair.i, pair.j, cells, 0.0, 0.0});
    }
  }
}

int NonlinearNetwork::n_contacts() const {
  const std::vector<State> pairs = states(position_);
  return static_cast<int>(std::count_if(pairs.begin() + static_cast<std::ptrdiff_t>(n_bonds_), pairs.end(),
                                        [](const State& pair) { return pair.r < 1.0; }));
}

/// What PETSc calls back.
struct SnesGlue {
  NonlinearNetwork& network;
  Mat pair_matrix;

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
        entries[3 * n + c] = network.held_[n] ? held[3 * n + c] : sign * values[n][c];
      }
    }
    check(VecRestoreArrayRead(held_values, &held), "VecRestoreArrayRead");
    check(VecRestoreArrayWrite(out, &entries), "VecRestoreArrayWrite");
  }

  static PetscErrorCode residual(SNES, Vec displacement, Vec out, void* context) {
    const auto* self = static_cast<const SnesGlue*>(context);
    self->write(self->network.forces(self->positions(displacement)), -1.0, displacement, out);
    return 0;
  }

  static PetscErrorCode jacobian(SNES, Vec displacement, Mat, Mat pair, void* context) {
    auto* self = static_cast<SnesGlue*>(context);
    self->network.linearised_ = self->network.states(self->positions(displacement));
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
      u[n] = self->network.held_[n] ? Vector3(Vector3::Zero()) : Vector3(Eigen::Map<const Vector3>(entries + 3 * n));
    }
    PetscCall(VecRestoreArrayRead(in, &entries));
    self->write(self->network.force_derivative(u), -1.0, in, out);
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
  check(KSPSetTolerances(linear, 1e-4, PETSC_DEFAULT, PETSC_DEFAULT, 2000), "KSPSetTolerances");
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

void NonlinearNetwork::relax(double tolerance) {
  for (int list = 0; list < most_lists; ++list) {
    find_contacts();
    const std::vector<Vector3> before = position_;
    relax_once(tolerance);
    const auto still_valid = [](const Vector3& a, const Vector3& b) { return (a - b).norm() < 0.5 * contact_margin; };
    if (std::equal(before.begin(), before.end(), position_.begin(), still_valid)) {
      return;
    }
  }
  throw std::runtime_error("the static solve moves nodes too far for its list of contacts; take smaller steps");
}

void NonlinearNetwork::relax_once(double tolerance) {
  std::vector<int> blocks_in_row(n_nodes(), 1);
  for (const Link& link : links_) {
    ++blocks_in_row[link.i];
    ++blocks_in_row[link.j];
  }
  const Matrix pair = empty_pair_matrix(n_nodes(), blocks_in_row);
  SnesGlue glue{*this, pair};
  const int n = 3 * n_nodes();
  Matrix shell;
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, &glue, shell.address()), "MatCreateShell");
  check(MatShellSetOperation(shell, MATOP_MULT, reinterpret_cast<void (*)()>(SnesGlue::multiply)),
        "MatShellSetOperation");
  Vector u, r;
  check(VecCreateSeq(PETSC_COMM_SELF, n, u.address()), "VecCreateSeq");
  check(VecSetBlockSize(u, 3), "VecSetBlockSize");
  check(VecDuplicate(u, r.address()), "VecDuplicate");
  if (period_) {
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
}

} // namespace boba::calibration
