// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"
#include "bpm/parallel/ranks.h"

namespace boba {

/// Rank 0's packing for all ranks, to the last bit: none of them makes its own.
void share_packing(Packing& packing, const Ranks& ranks);

} // namespace boba
