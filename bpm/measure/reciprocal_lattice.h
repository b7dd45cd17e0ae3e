// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <cstdint>
#include <vector>

namespace boba::measure {

/// Wave vectors q(n) = 2 pi h^-T n with one n1, one n2 and n3 = low .. high.
struct ReciprocalRow {
  int n1 = 0, n2 = 0, low = 0, high = -1;
  std::int64_t first = 0; ///< number of the row's first vector in the whole list
  int size() const { return high - low + 1; }
};

/// One half of the reciprocal lattice of a cell up to q_max, row by row: of n and -n only the one whose first nonzero
/// component is positive (amplitudes at q and -q are complex conjugates), without n = 0.
class ReciprocalLattice {
public:
  /// \param q_max 1/d, positive
  /// \throws std::invalid_argument for a box that is not periodic in all directions, a bad q_max, or one with more
  /// than 2^31 vectors.
  ReciprocalLattice(const Box& box, double q_max);

  const std::vector<ReciprocalRow>& rows() const { return rows_; }
  std::int64_t n_vectors() const { return n_vectors_; }
  /// q(n), 1/d.
  Vector3 q(int n1, int n2, int n3) const { return b_ * Vector3(n1, n2, n3); }

private:
  Matrix3 b_; ///< columns: the reciprocal vectors, 2 pi h^-T
  std::vector<ReciprocalRow> rows_;
  std::int64_t n_vectors_ = 0;
};

} // namespace boba::measure
