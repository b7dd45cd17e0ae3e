// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/moving_packing.h"

namespace boba {

/// Bulk modulus of a packing under an affine change of volume, dP / d ln(1/V) of the virial part of the pressure, from
/// two evaluations at +- 1e-5 in length (k/d). The packing is as before when it returns. Collective.
double affine_bulk_modulus(MovingPacking& moving);

/// Stiffness of the packing's stress component c (xx yy zz xy xz yz) against its own affine strain, d sigma_c / d e_c
/// of the virial part, from two evaluations in the same way (k/d). Collective.
double affine_stiffness(MovingPacking& moving, int c);

/// Time that sound needs across the cell's shortest side, min(L) / sqrt(K V / M) with the packing's mass M (tau);
/// `bulk_modulus` K in k/d.
double sound_crossing(const MovingPacking& moving, double bulk_modulus);

} // namespace boba
