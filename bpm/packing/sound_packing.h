// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"

namespace boba {

/// Looks whether a packing can be computed with, wherever it comes from: every template is sound (unsound_part), every
/// grain names one and has a finite alpha, cell, positions and velocities are within largest_coordinate, and no two
/// bonded nodes lie at the same place, where their bond has no direction.
///
/// Positions and velocities may be missing (ranks other than 0 have none). One pass over the nodes and the bonds.
/// \throws std::invalid_argument with what, where, the value and what is allowed.
void check_sound(const Packing& packing);

} // namespace boba
