// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"

#include <array>

namespace boba::bench {

/// The same packing so many times along each cell vector: a larger periodic packing in the same state.
Packing repeated(const Packing& packing, const std::array<int, 3>& times);

} // namespace boba::bench
