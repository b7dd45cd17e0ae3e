// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace boba::continuum {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// A sparse L D L^T factorisation, kept to be used for many right-hand sides.
///
/// The meridian problems have 10^3 to 10^5 unknowns; there the simplicial factorisation with a minimum-degree
/// ordering is faster than the multifrontal ones on the reference BLAS (docs/performance-continuum.md).
class DirectSolver {
public:
  /// Factorises the symmetric matrix (only its lower triangle is read). Throws std::runtime_error when it is singular.
  void factorise(const SparseMatrix& matrix);
  /// True when the factorised matrix is positive definite.
  bool is_positive() const { return factor_.vectorD().minCoeff() > 0; }
  /// Returns matrix^-1 rhs.
  Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const;
  /// Returns B^T matrix^-1 B for a sparse B with few columns, never forming matrix^-1 B.
  Eigen::MatrixXd condense(const SparseMatrix& columns) const;

private:
  Eigen::SimplicialLDLT<SparseMatrix> factor_;
  bool analysed_ = false;
};

} // namespace boba::continuum
