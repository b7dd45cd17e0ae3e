// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace boba {

/// The components of the cell: three lengths and three tilts, in the order of Totals::stress.
inline constexpr std::array<const char*, 6> cell_components = {"xx", "yy", "zz", "xy", "xz", "yz"};
/// Row and column of a component in the cell matrix.
inline constexpr std::array<std::array<int, 2>, 6> component_place = {{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};

} // namespace boba
