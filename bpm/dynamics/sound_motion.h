// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/moving_packing.h"

namespace boba {

/// Looks whether a state that was read can be computed with, as check_sound does with a packing: nodes and velocities
/// within largest_coordinate, forces finite, a cell that is one, clamps of nodes that are there, no bond beyond
/// `largest_bond_stretch`. Collective. \throws std::invalid_argument with what, where and the value; RankError on
/// several ranks
void check_motion(const MovingPacking& moving);

} // namespace boba
