// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/direct_solver.h"

#include <stdexcept>
#include <vector>

namespace boba::continuum {
namespace {

/// Solves L x = b in place for one sparse b, visiting only the columns that the fill path of b reaches.
/// The elimination tree (parent of a column = first row below its diagonal) gives that path.
void forward_solve(const SparseMatrix& lower, Eigen::VectorXd& x, int first) {
  for (int column = first; column < lower.cols(); ++column) {
    const double value = x[column];
    if (value == 0) {
      continue;
    }
    for (SparseMatrix::InnerIterator it(lower, column); it; ++it) {
      if (it.row() != column) {
        x[it.row()] -= it.value() * value;
      }
    }
  }
}

} // namespace

void DirectSolver::factorise(const SparseMatrix& matrix) {
  if (!analysed_) {
    factor_.analyzePattern(matrix);
    analysed_ = true;
  }
  factor_.factorize(matrix);
  if (factor_.info() != Eigen::Success || !factor_.vectorD().allFinite()) {
    throw std::runtime_error("the stiffness matrix could not be factorised: it is singular");
  }
}

Eigen::VectorXd DirectSolver::solve(const Eigen::VectorXd& rhs) const {
  return factor_.solve(rhs);
}

Eigen::MatrixXd DirectSolver::condense(const SparseMatrix& columns) const {
  // With P A P^T = L D L^T:  B^T A^-1 B = Y^T D^-1 Y,  Y = L^-1 P B: half the work of full solves.
  const SparseMatrix& lower = factor_.matrixL().nestedExpression();
  const Eigen::VectorXi& position = factor_.permutationP().indices();
  const int n = int(lower.rows());
  const int m = int(columns.cols());
  Eigen::MatrixXd y(n, m);
  Eigen::VectorXd work(n);
  int lowest = n;
  for (int j = 0; j < m; ++j) {
    work.setZero();
    int first = n;
    for (SparseMatrix::InnerIterator it(columns, j); it; ++it) {
      work[position[it.row()]] = it.value();
      first = std::min(first, position[it.row()]);
    }
    lowest = std::min(lowest, first);
    forward_solve(lower, work, first);
    y.col(j) = work;
  }
  // Rows that no column reaches are zero and are left out of the dense product.
  std::vector<int> reached;
  for (int i = lowest; i < n; ++i) {
    if (y.row(i).any()) {
      reached.push_back(i);
    }
  }
  const auto& pivots = factor_.vectorD();
  Eigen::MatrixXd packed(Eigen::Index(reached.size()), m), divided(Eigen::Index(reached.size()), m);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    packed.row(Eigen::Index(i)) = y.row(reached[i]);
    divided.row(Eigen::Index(i)) = y.row(reached[i]) / pivots[reached[i]];
  }
  Eigen::MatrixXd result(m, m);
  result.noalias() = packed.transpose() * divided;
  return result;
}

} // namespace boba::continuum
