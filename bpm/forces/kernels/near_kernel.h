// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"

namespace {

using boba::kernels::SortedNodes;

#if !defined(__AVX512F__)
/// Branch-free: every place is written, and the count moves on only past those that are near.
std::int32_t near_places(const SortedNodes& nodes, std::int32_t begin, std::int32_t end, const double* p, double reach2,
                         std::int32_t* found) {
  std::int32_t n = 0;
  for (std::int32_t place = begin; place < end; ++place) {
    const double dx = nodes.x[place] - p[0], dy = nodes.y[place] - p[1], dz = nodes.z[place] - p[2];
    found[n] = place;
    n += dx * dx + dy * dy + dz * dz < reach2;
  }
  return n;
}
#else
std::int32_t near_places(const SortedNodes& nodes, std::int32_t begin, std::int32_t end, const double* p, double reach2,
                         std::int32_t* found) {
  const __m512d px = _mm512_set1_pd(p[0]), py = _mm512_set1_pd(p[1]), pz = _mm512_set1_pd(p[2]);
  const __m512d limit = _mm512_set1_pd(reach2);
  const __m256i first_eight = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  std::int32_t n = 0;
  for (std::int32_t place = begin; place < end; place += 8) {
    const __mmask8 inside = static_cast<__mmask8>(end - place >= 8 ? 0xff : (1 << (end - place)) - 1);
    const __m512d dx = _mm512_sub_pd(_mm512_maskz_loadu_pd(inside, nodes.x + place), px);
    const __m512d dy = _mm512_sub_pd(_mm512_maskz_loadu_pd(inside, nodes.y + place), py);
    const __m512d dz = _mm512_sub_pd(_mm512_maskz_loadu_pd(inside, nodes.z + place), pz);
    const __m512d r2 =
        _mm512_add_pd(_mm512_add_pd(_mm512_mul_pd(dx, dx), _mm512_mul_pd(dy, dy)), _mm512_mul_pd(dz, dz));
    const __mmask8 hit = _mm512_mask_cmp_pd_mask(inside, r2, limit, _CMP_LT_OQ);
    const __m256i places = _mm256_add_epi32(_mm256_set1_epi32(place), first_eight);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(found + n), _mm256_maskz_compress_epi32(hit, places));
    n += __builtin_popcount(hit);
  }
  return n;
}
#endif

} // namespace
