// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <type_traits>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

/// A function of a law. It is always compiled into its caller: the kernels are compiled once for each instruction set,
/// and a copy of its own, made for the widest one, could otherwise be linked into code for any machine.
#define BOBA_LAW_FUNCTION [[gnu::always_inline]] constexpr

namespace boba {

/// True when a comparison holds: of two vectors, in some lane.
template <class Comparison> [[gnu::always_inline]] inline bool holds_in_any(Comparison lanes) {
  if constexpr (std::is_integral_v<Comparison>) {
    return lanes != 0;
  } else {
#if defined(__AVX512F__)
    if constexpr (sizeof(Comparison) == 64) {
      return _mm512_test_epi32_mask((__m512i)lanes, (__m512i)lanes) != 0;
    }
#endif
#if defined(__AVX2__)
    if constexpr (sizeof(Comparison) == 32) {
      return _mm256_testz_si256((__m256i)lanes, (__m256i)lanes) == 0;
    }
    if constexpr (sizeof(Comparison) == 16) {
      return _mm_testz_si128((__m128i)lanes, (__m128i)lanes) == 0;
    }
#endif
    bool holds = false;
    for (unsigned l = 0; l < sizeof(Comparison) / sizeof(lanes[0]); ++l) {
      holds |= lanes[l] != 0;
    }
    return holds;
  }
}

} // namespace boba
