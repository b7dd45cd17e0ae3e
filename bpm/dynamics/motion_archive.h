// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/moving_packing.h"

namespace boba {

/// Writes all that a packing in motion needs to continue bit for bit. Each rank adds the nodes of its own grains; the
/// rest is the same on all. Collective.
void save_motion(const MovingPacking& moving, SavedState& saved);

/// Takes a saved state over; of nodes, rank 0's. Collective.
/// \throws std::runtime_error, std::out_of_range when the state belongs to another packing or lacks a number.
void restore_motion(MovingPacking& moving, const SavedState& saved);

} // namespace boba
