// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Random123/philox.h>
#include <array>
#include <cstdint>

namespace boba::measure {

/// Three uniform numbers in [0, 1) with 42 bits each: point `index` of the sequence `seed`, the same whoever draws it.
///
/// The bits are Random123's Philox4x32-10 of the counter `index` and the key `seed`.
/// Source: Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC11 (2011), section 3.3.
inline std::array<double, 3> random_point(std::uint64_t seed, std::uint64_t index) {
  const auto bits = r123::Philox4x32()({{static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32)}},
                                       {{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}});
  // The fourth word gives each coordinate ten more bits.
  std::array<double, 3> u{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t low = (bits[3] >> (10 * axis)) & 0x3FF;
    u[axis] = static_cast<double>((std::uint64_t{bits[axis]} << 10) | low) * 0x1p-42;
  }
  return u;
}

} // namespace boba::measure
