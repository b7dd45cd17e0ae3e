// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/network/connected_network.h"

#include <limits>

namespace boba::calibration {

/// Checks that no motion but a rigid one leaves every bond unstretched, by one solve of A0 u = f with a random f: a
/// mechanism takes up a part of f that no bond can balance.
/// \throws std::invalid_argument naming the node that moves most when the network is not rigid.
void require_rigid(const LinearNetwork& network);

/// Where a network first loses its stability as alpha falls (or rises).
struct StabilityLimit {
  double alpha = 0.0; ///< k d; -+ infinity when there is none
  int node = 0;       ///< the node that moves most in the first unstable mode
  double participation =
      0.0; ///< 1 / (n sum |v_i|^4): share of nodes in that mode, about 1 for a wave, 1/n for one node
};

/// The alpha < 0 (lower) or > 0 (upper) nearest to zero at which A0 + alpha A1 is singular: alpha = -1/mu for the
/// extreme real part mu of the spectrum of A0^-1 A1. Krylov-Schur (SLEPc), rigid motions deflated; good to 1e-4.
/// \throws std::runtime_error when the eigensolver does not converge.
StabilityLimit lower_stability_limit(const LinearNetwork& network);
StabilityLimit upper_stability_limit(const LinearNetwork& network);

/// The edge of the interval for shear waves alone, alpha = -G0 / G1 of the affine moduli: a quick bound, about -1.1 k
/// d.
double affine_shear_limit(const LinearNetwork& network);

} // namespace boba::calibration
