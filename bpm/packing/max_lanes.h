// SPDX-License-Identifier: GPL-3.0-or-later
// Free of library types: the kernels include it.
#pragma once

namespace boba {

/// Most grains that a block of lanes holds.
inline constexpr int max_lanes = 16;

} // namespace boba
