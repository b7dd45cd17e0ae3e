// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/network/connected_network.h"
#include "calibration/network/petsc_handle.h"

namespace boba::calibration {

/// The stiffness A0 + alpha A1 of a network as PETSc sees it, for a whole sweep of alpha.
///
/// * `matrix()` applies the operator from the bond list (no matrix of second neighbours, 16 times smaller than the
///   assembled one and several times as fast);
/// * `pair_matrix()` is its nearest-neighbour part P = sum over bonds of spring(alpha_p) B_b^T B_b in 3x3 blocks,
/// from
///   which the preconditioner is made: symmetric and positive, alpha_p = max(alpha, -0.7);
/// * `assembled()` is the whole operator in 3x3 blocks, for checks and for solvers that need its entries.
/// All know their null space: the translations, and the rotations of a network without a period.
class NetworkOperator {
public:
  explicit NetworkOperator(const LinearNetwork& network);
  NetworkOperator(const NetworkOperator&) = delete;
  NetworkOperator& operator=(const NetworkOperator&) = delete;

  void set_alpha(double alpha);
  double alpha() const { return alpha_; }
  const LinearNetwork& network() const { return network_; }
  Mat matrix() const { return shell_; }
  Mat pair_matrix() const { return pair_; }
  MatNullSpace null_space() const { return null_space_; }

  /// A0 and A1 in 3x3 blocks; the many-body part of A1 reaches second neighbours.
  Matrix assembled_a0() const;
  Matrix assembled_a1() const;
  /// A0 + alpha A1, with the null space.
  Matrix assembled(double alpha) const;

private:
  const LinearNetwork& network_;
  double alpha_ = 0.0;
  Matrix shell_;
  Matrix pair0_, pair1_; // the pair parts of A0 and of A1
  Matrix pair_;
  NullSpace null_space_;
};

} // namespace boba::calibration
