// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/reciprocal_lattice.h"

#include <complex>
#include <span>
#include <vector>

namespace boba::measure {

/// Sums exp(i q.r) over the nodes of one grain, for consecutive rows of the reciprocal lattice with the same n1.
///
/// The inner loop lives in its own file, compiled for several instruction sets.
class PhaseSums {
public:
  /// Starts at `first` (a row) for these nodes. The nodes' phases are kept until the next start.
  void start(const Box& box, std::span<const Vector3> nodes, const ReciprocalRow& first);
  /// Moves on to `row`, whose n2 must be the present one or larger, and fills `sums` (size row.size()).
  void sum_row(const ReciprocalRow& row, std::span<std::complex<double>> sums);

private:
  void move_to(const ReciprocalRow& row);

  // Real and imaginary parts, padded to whole groups of nodes with zeros.
  std::vector<double> phase_re_, phase_im_; ///< at (n1, n2, low) of the present row
  std::vector<double> step2_re_, step2_im_; ///< exp(i b2.r)
  std::vector<double> step3_re_, step3_im_; ///< exp(i b3.r)
  std::vector<double> lanes_;               ///< scratch: sums of the row, still one a lane
  ReciprocalRow present_;
};

} // namespace boba::measure
