// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/archive.h"
#include "bpm/packing/packing.h"

namespace boba {

/// A packing as it is at the start of a run, velocities excepted: cell, networks, grains, ids and positions. A packing
/// that is read is at rest. \throws SavedStateError when a field is missing, std::invalid_argument when the parts do
/// not fit together.
void archive_packing(Archive& archive, Packing& packing);

} // namespace boba
