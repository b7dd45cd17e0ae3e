// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/network/elastic_constants.h"
#include "calibration/network/network_operator.h"

#include <functional>
#include <vector>

namespace boba::calibration {

/// The Voigt unit strain p = 0 .. 5 (xx yy zz yz xz xy; shear: engineering strain 1).
Matrix3 unit_strain(int p);

/// Stiffness without relaxation: every node follows the mean strain exactly (k/d).
Stiffness affine_stiffness(const LinearNetwork& network, double alpha);

struct SolveSettings {
  double relative_tolerance = 1e-5; ///< of the residual force; the stiffness is good to about its square
  int max_iterations = 2000;
  bool assembled = false; ///< solve with the assembled 3x3 blocks instead of the bond list
};

struct StiffnessSolution {
  double alpha = 0.0;
  Stiffness stiffness; ///< relaxed, k/d
  int iterations = 0;  ///< of the six solves together
};

/// Relaxed stiffness of a periodic network for each alpha, in the order given.
///
///     C_pq = a_p^T T (a_q + B u_q) / volume,   B^T T B u_q = -B^T T a_q,   T = T0 + alpha T1
///
/// with a_p the bonds' stretches under unit strain p. Each alpha starts from the solutions of the previous ones. The
/// Krylov method and preconditioner can be changed through PETSC_OPTIONS with the prefix `network_` (`-network_ksp_type
/// cg`). \throws std::invalid_argument for a network without a period; std::runtime_error with the end of the residual
/// history when a solve does not converge.
std::vector<StiffnessSolution> relaxed_stiffness(const LinearNetwork& network, const std::vector<double>& alphas,
                                                 const SolveSettings& settings = {});

} // namespace boba::calibration
