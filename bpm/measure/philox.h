// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

namespace boba::measure {

/// Philox4x32-10: 128 random bits as a function of a counter and a key, so that the i-th number of a seed is the same
/// whoever draws it.
///
/// Source: Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC11 (2011), section 3.3.
constexpr std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                  std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t product0 = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t product1 = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(product1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(product1),
               static_cast<std::uint32_t>(product0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(product0)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

/// Three uniform numbers in [0, 1) with 42 bits each: point `index` of the sequence `seed`.
constexpr std::array<double, 3> random_point(std::uint64_t seed, std::uint64_t index) {
  const auto bits = philox4x32({static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), 0, 0},
                               {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  // The fourth word gives each coordinate ten more bits.
  std::array<double, 3> u{};
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t low = (bits[3] >> (10 * axis)) & 0x3FF;
    u[axis] = static_cast<double>((std::uint64_t{bits[axis]} << 10) | low) * 0x1p-42;
  }
  return u;
}

} // namespace boba::measure
