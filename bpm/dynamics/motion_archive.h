// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/archive.h"
#include "bpm/dynamics/moving_packing.h"

namespace boba {

/// All that a packing in motion needs to continue bit for bit. Saved, each rank adds the nodes of its own grains and
/// the rest is the same on all; read, nodes are rank 0's. Collective. \throws SavedStateError when what is read belongs
/// to another packing or lacks a field.
void archive_motion(Archive& archive, MovingPacking& moving);

} // namespace boba
