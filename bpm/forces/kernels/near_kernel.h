// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"

namespace boba::kernels {
namespace {

#if !defined(__AVX512F__)
/// Branch-free: every place is written, and the count moves on only past those that are near.
std::int32_t near_places(const SortedNodes& nodes, const PlaceRange* ranges, int n_ranges, const double* p,
                         double reach2, std::int32_t* found) {
  const auto px = static_cast<float>(p[0]), py = static_cast<float>(p[1]), pz = static_cast<float>(p[2]);
  const auto limit = static_cast<float>(reach2);
  std::int32_t n = 0;
  for (const PlaceRange* range = ranges; range != ranges + n_ranges; ++range) {
    for (std::int32_t place = range->begin; place < range->end; ++place) {
      const float dx = nodes.x[place] - px, dy = nodes.y[place] - py, dz = nodes.z[place] - pz;
      found[n] = place;
      n += dx * dx + dy * dy + dz * dz < limit;
    }
  }
  return n;
}
#else
std::int32_t near_places(const SortedNodes& nodes, const PlaceRange* ranges, int n_ranges, const double* p,
                         double reach2, std::int32_t* found) {
  constexpr int width = near_padding;
  const __m512 px = _mm512_set1_ps(static_cast<float>(p[0]));
  const __m512 py = _mm512_set1_ps(static_cast<float>(p[1]));
  const __m512 pz = _mm512_set1_ps(static_cast<float>(p[2]));
  const __m512 limit = _mm512_set1_ps(static_cast<float>(reach2));
  const __m512i numbers = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  std::int32_t n = 0;
  for (const PlaceRange* range = ranges; range != ranges + n_ranges; ++range) {
    for (std::int32_t place = range->begin; place < range->end; place += width) {
      const std::int32_t left = range->end - place;
      const auto inside = static_cast<__mmask16>(left >= width ? 0xffff : (1 << left) - 1);
      const __m512 dx = _mm512_sub_ps(_mm512_maskz_loadu_ps(inside, nodes.x + place), px);
      const __m512 dy = _mm512_sub_ps(_mm512_maskz_loadu_ps(inside, nodes.y + place), py);
      const __m512 dz = _mm512_sub_ps(_mm512_maskz_loadu_ps(inside, nodes.z + place), pz);
      const __m512 r2 = _mm512_fmadd_ps(dx, dx, _mm512_fmadd_ps(dy, dy, _mm512_mul_ps(dz, dz)));
      const __mmask16 hit = _mm512_mask_cmp_ps_mask(inside, r2, limit, _CMP_LT_OQ);
      const __m512i places = _mm512_add_epi32(_mm512_set1_epi32(place), numbers);
      _mm512_storeu_si512(found + n, _mm512_maskz_compress_epi32(hit, places));
      n += __builtin_popcount(hit);
    }
  }
  return n;
}
#endif

} // namespace
} // namespace boba::kernels
