// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace boba {

/// Place of a cell along the Hilbert curve through a cube of 2^levels cells a side, 0 .. 8^levels - 1.
///
/// \param cell numbers of the cell along x, y, z, each below 2^levels  \param levels 1 .. 21
/// Cost: about 20 integer operations for each level.
/// Source: C. H. Hamilton, "Compact Hilbert Indices", Dalhousie University CS-2006-07.
std::uint64_t hilbert_index(const std::array<std::uint32_t, 3>& cell, int levels);

} // namespace boba
