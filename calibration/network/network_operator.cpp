// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/network_operator.h"

#include <algorithm>
#include <array>
#include <map>

namespace boba::calibration {

namespace {

constexpr double lowest_pair_alpha = -0.7; // keeps every spring of the preconditioner positive for r0 > 0.7

PetscErrorCode multiply(Mat matrix, Vec in, Vec out) {
  const NetworkOperator* self = nullptr;
  const double* u = nullptr;
  double* f = nullptr;
  PetscCall(MatShellGetContext(matrix, &self));
  PetscCall(VecGetArrayRead(in, &u));
  PetscCall(VecGetArrayWrite(out, &f));
  self->network().multiply(u, self->alpha(), f);
  PetscCall(VecRestoreArrayWrite(out, &f));
  PetscCall(VecRestoreArrayRead(in, &u));
  return 0;
}

/// Rows of 3x3 blocks, the form in which a matrix is gathered before PETSc gets it.
using BlockRows = std::vector<std::map<int, Matrix3>>;

void add_block(BlockRows& rows, int i, int j, const Matrix3& block) {
  rows[i].try_emplace(j, Matrix3::Zero()).first->second += block;
}

Matrix to_petsc(const BlockRows& rows) {
  const int n = static_cast<int>(rows.size());
  std::vector<int> blocks_in_row(n);
  std::transform(rows.begin(), rows.end(), blocks_in_row.begin(), [](const auto& row) { return row.size(); });
  Matrix matrix;
  check(MatCreateSeqBAIJ(PETSC_COMM_SELF, 3, 3 * n, 3 * n, 0, blocks_in_row.data(), matrix.address()),
        "MatCreateSeqBAIJ");
  check(MatSetOption(matrix, MAT_ROW_ORIENTED, PETSC_FALSE), "MatSetOption"); // Eigen stores columns
  for (int i = 0; i < n; ++i) {
    for (const auto& [j, block] : rows[i]) {
      check(MatSetValuesBlocked(matrix, 1, &i, 1, &j, block.data(), INSERT_VALUES), "MatSetValuesBlocked");
    }
  }
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyBegin");
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY), "MatAssemblyEnd");
  return matrix;
}

/// sum over bonds of weight(b) B_b^T B_b. `part`: 0 for alpha = 0, 1 for the change per alpha.
BlockRows pair_rows(const LinearNetwork& network, int part) {
  BlockRows rows(network.n_nodes());
  for (const LinearBond& bond : network.bonds()) {
    const Matrix3 block = bond.spring[part] * bond.e * bond.e.transpose();
    add_block(rows, bond.i, bond.i, block);
    add_block(rows, bond.j, bond.j, block);
    add_block(rows, bond.i, bond.j, -block);
    add_block(rows, bond.j, bond.i, -block);
  }
  return rows;
}

/// Subtracts B^T W N^T R B: with the nodal sums q_m = sum_b r0^2 B_b u = G_m u, bond b pulls with -swelling (q_i +
/// q_j).
void subtract_many_body(BlockRows& rows, const LinearNetwork& network, int part) {
  std::vector<std::map<int, Vector3>> gather(network.n_nodes()), scatter(network.n_nodes());
  const auto add = [](std::map<int, Vector3>& row, int column, const Vector3& value) {
    row.try_emplace(column, Vector3::Zero()).first->second += value;
  };
  for (const LinearBond& bond : network.bonds()) {
    const Vector3 weighted = bond.r0 * bond.r0 * bond.e, pull = bond.swelling[part] * bond.e;
    for (const int m : {bond.i, bond.j}) {
      add(gather[m], bond.i, weighted);
      add(gather[m], bond.j, -weighted);
      add(scatter[bond.i], m, pull);
      add(scatter[bond.j], m, -pull);
    }
  }
  for (int i = 0; i < network.n_nodes(); ++i) {
    for (const auto& [m, pull] : scatter[i]) {
      for (const auto& [j, weighted] : gather[m]) {
        add_block(rows, i, j, -pull * weighted.transpose());
      }
    }
  }
}

Vector coordinates(const LinearNetwork& network) {
  const int n = 3 * network.n_nodes();
  Vector x;
  check(VecCreateSeq(PETSC_COMM_SELF, n, x.address()), "VecCreateSeq");
  check(VecSetBlockSize(x, 3), "VecSetBlockSize");
  double* entries = nullptr;
  check(VecGetArrayWrite(x, &entries), "VecGetArrayWrite");
  for (int i = 0; i < network.n_nodes(); ++i) {
    std::copy_n(network.position()[i].data(), 3, entries + 3 * i);
  }
  check(VecRestoreArrayWrite(x, &entries), "VecRestoreArrayWrite");
  return x;
}

NullSpace rigid_motions(const LinearNetwork& network) {
  NullSpace space;
  if (!network.period()) {
    check(MatNullSpaceCreateRigidBody(coordinates(network), space.address()), "MatNullSpaceCreateRigidBody");
    return space;
  }
  std::vector<Vector> translation(3);
  std::array<Vec, 3> raw{};
  for (int c = 0; c < 3; ++c) {
    check(VecCreateSeq(PETSC_COMM_SELF, 3 * network.n_nodes(), translation[c].address()), "VecCreateSeq");
    check(VecSetBlockSize(translation[c], 3), "VecSetBlockSize");
    check(VecStrideSet(translation[c], c, 1.0), "VecStrideSet");
    check(VecNormalize(translation[c], nullptr), "VecNormalize");
    raw[c] = translation[c];
  }
  check(MatNullSpaceCreate(PETSC_COMM_SELF, PETSC_FALSE, 3, raw.data(), space.address()), "MatNullSpaceCreate");
  return space;
}

} // namespace

NetworkOperator::NetworkOperator(const LinearNetwork& network)
    : network_(network), null_space_(rigid_motions(network)) {
  const int n = 3 * network.n_nodes();
  check(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, this, shell_.address()), "MatCreateShell");
  check(MatShellSetOperation(shell_, MATOP_MULT, reinterpret_cast<void (*)()>(multiply)), "MatShellSetOperation");
  pair0_ = to_petsc(pair_rows(network, 0));
  pair1_ = to_petsc(pair_rows(network, 1));
  check(MatDuplicate(pair0_, MAT_COPY_VALUES, pair_.address()), "MatDuplicate");
  const Vector x = coordinates(network);
  NullSpace near_null_space; // multigrid wants the rotations too, though a periodic network has none
  check(MatNullSpaceCreateRigidBody(x, near_null_space.address()), "MatNullSpaceCreateRigidBody");
  check(MatSetNearNullSpace(pair_, near_null_space), "MatSetNearNullSpace");
  for (Mat matrix : {static_cast<Mat>(shell_), static_cast<Mat>(pair_)}) {
    check(MatSetNullSpace(matrix, null_space_), "MatSetNullSpace");
    check(MatSetTransposeNullSpace(matrix, null_space_), "MatSetTransposeNullSpace");
  }
}

void NetworkOperator::set_alpha(double alpha) {
  alpha_ = alpha;
  check(MatCopy(pair0_, pair_, SAME_NONZERO_PATTERN), "MatCopy");
  check(MatAXPY(pair_, std::max(alpha, lowest_pair_alpha), pair1_, SAME_NONZERO_PATTERN), "MatAXPY");
}

Matrix NetworkOperator::assembled_a0() const {
  BlockRows rows = pair_rows(network_, 0);
  const auto has_swelling = [](const LinearBond& bond) { return bond.swelling[0] != 0.0; };
  if (std::any_of(network_.bonds().begin(), network_.bonds().end(), has_swelling)) {
    subtract_many_body(rows, network_, 0);
  }
  return to_petsc(rows);
}

Matrix NetworkOperator::assembled_a1() const {
  BlockRows rows = pair_rows(network_, 1);
  subtract_many_body(rows, network_, 1);
  return to_petsc(rows);
}

Matrix NetworkOperator::assembled(double alpha) const {
  Matrix matrix = assembled_a1();
  check(MatScale(matrix, alpha), "MatScale");
  check(MatAXPY(matrix, 1.0, assembled_a0(), SUBSET_NONZERO_PATTERN), "MatAXPY");
  check(MatSetNullSpace(matrix, null_space_), "MatSetNullSpace");
  check(MatSetTransposeNullSpace(matrix, null_space_), "MatSetTransposeNullSpace");
  return matrix;
}

} // namespace boba::calibration
