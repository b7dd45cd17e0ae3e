// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/network/linear_network.h"

#include <limits>

namespace boba::calibration {

/// Checks that no motion but a rigid one leaves every bond unstretched, by one solve of A0 u = f with a random f: a
/// mechanism takes up a part of f that no bond can balance.
/// \throws std::invalid_argument naming the node that moves most when the network is not rigid.
void require_rigid(const LinearNetwork& network);

/// The interval of alpha (k d) in which the undeformed network is stable. `upper` is infinite if no alpha > 0 is too large.
struct StabilityLimits {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  int lower_node = 0; ///< the node that moves most in the first unstable mode
  double lower_participation = 0.0; ///< 1 / (n sum |v_i|^4): share of nodes in that mode, about 1 for a wave, 1/n for one node
};

/// Where A0 + alpha A1 first becomes singular: alpha = -1/mu for the extreme real parts mu of the spectrum of A0^-1 A1.
/// Krylov-Schur (SLEPc) on the network's own operator, rigid motions deflated; mu is good to 1e-4.
/// \throws std::runtime_error when the eigensolver does not converge.
StabilityLimits stability_limits(const LinearNetwork& network);

/// The edge of the interval for shear waves alone, alpha = -G0 / G1 of the affine moduli: a quick bound, about -1.1 k d.
double affine_shear_limit(const LinearNetwork& network);

} // namespace boba::calibration
