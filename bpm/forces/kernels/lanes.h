// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only, once for each instruction set: everything here lives in an unnamed namespace of its own.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace {

#if defined(__AVX512F__)
constexpr int native_lanes = 8;
#elif defined(__AVX2__)
constexpr int native_lanes = 4;
#else
constexpr int native_lanes = 2;
#endif

/// The widest register of doubles of this instruction set; + - * / and comparisons act lane by lane.
using Wide = double __attribute__((vector_size(8 * native_lanes)));
using WideFloat = float __attribute__((vector_size(4 * native_lanes)));
using WideInt = std::int32_t __attribute__((vector_size(4 * native_lanes)));

template <class V> constexpr int lanes_of = 1;
template <> constexpr int lanes_of<Wide> = native_lanes;

template <class V> inline V load(const double* from) {
  V value;
  std::memcpy(&value, from, sizeof(V));
  return value;
}
template <class V> inline void store(double* to, V value) { std::memcpy(to, &value, sizeof(V)); }

template <class V> inline V splat(double value) { return value - V{}; }
template <> inline double splat<double>(double value) { return value; }

/// a * b + c and c - a * b, fused where the machine can. Written out because the compiler is told not to contract by itself:
/// two versions of a loop (with and without a virial) must give the same forces to the last bit.
inline double multiply_add(double a, double b, double c) {
#if defined(__FMA__)
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}
inline Wide multiply_add(Wide a, Wide b, Wide c) {
#if defined(__AVX512F__)
  return (Wide)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif defined(__FMA__)
  return (Wide)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
  return a * b + c;
#endif
}
inline double subtract_product(double c, double a, double b) { return multiply_add(-a, b, c); }
inline Wide subtract_product(Wide c, Wide a, Wide b) { return multiply_add(-a, b, c); }

inline double larger(double a, double b) { return a > b ? a : b; }
inline Wide larger(Wide a, Wide b) { return a > b ? a : b; }

inline double sum_of(double v) { return v; }
inline double sum_of(Wide v) {
  double sum = 0.0;
  for (int l = 0; l < native_lanes; ++l) {
    sum += v[l];
  }
  return sum;
}
inline double largest_of(double v) { return v; }
inline double largest_of(Wide v) {
  double largest = v[0];
  for (int l = 1; l < native_lanes; ++l) {
    largest = larger(largest, v[l]);
  }
  return largest;
}

inline double inverse_sqrt(double x) { return 1.0 / std::sqrt(x); }

/// 1 / sqrt(x) to about one unit in the last place. The hardware's square root and division take several times as long
/// as its 14-bit estimate and one step of the series (1 - h)^(-1/2) = 1 + h/2 + 3h^2/8 + 5h^3/16, h = 1 - x y^2.
inline Wide inverse_sqrt(Wide x) {
#if defined(__AVX512F__)
  const Wide y = (Wide)_mm512_maskz_rsqrt14_pd(0xff, (__m512d)x);
  const Wide h = subtract_product(splat<Wide>(1.0), x * y, y);
  const Wide series = multiply_add(h, multiply_add(h, splat<Wide>(0.3125), splat<Wide>(0.375)), splat<Wide>(0.5));
  return multiply_add(y, h * series, y);
#elif defined(__AVX2__)
  // The estimate exists for floats only and has 12 bits: one Newton step before the series.
  Wide y = __builtin_convertvector((WideFloat)_mm_rsqrt_ps((__m128)__builtin_convertvector(x, WideFloat)), Wide);
  y = y * subtract_product(splat<Wide>(1.5), 0.5 * x * y, y);
  const Wide h = subtract_product(splat<Wide>(1.0), x * y, y);
  return multiply_add(y, h * multiply_add(h, splat<Wide>(0.375), splat<Wide>(0.5)), y);
#else
  Wide y;
  for (int l = 0; l < native_lanes; ++l) {
    y[l] = 1.0 / std::sqrt(x[l]);
  }
  return y;
#endif
}

inline double cube_root(double x) { return std::cbrt(x); }

/// x^(1/3) for 1e-30 < x < 1e30, without division: y = x^(-1/3) from the exponent bits, two steps of the series
/// (1 - h)^(-1/3) = 1 + h/3 + 2h^2/9 + 14h^3/81, h = 1 - x y^3 (the first in float), then x y^2.
inline Wide cube_root_of_any(Wide x) {
  const WideFloat xf = __builtin_convertvector(x, WideFloat);
  // Dividing the float's bits by -3 divides its logarithm by -3; the constant makes |h| <= 0.102 over all x.
  const WideFloat bits = __builtin_convertvector((WideInt)xf, WideFloat);
  WideFloat yf = (WideFloat)__builtin_convertvector(1419900160.0f - bits * (1.0f / 3.0f), WideInt);
  const WideFloat hf = 1.0f - xf * yf * yf * yf;
  yf = yf + yf * (hf * (1.0f / 3.0f + hf * (2.0f / 9.0f + hf * (14.0f / 81.0f))));
  const Wide y = __builtin_convertvector(yf, Wide);
  const Wide h = subtract_product(splat<Wide>(1.0), x * y, y * y);
  const Wide series = multiply_add(h, multiply_add(h, splat<Wide>(14.0 / 81.0), splat<Wide>(2.0 / 9.0)), splat<Wide>(1.0 / 3.0));
  const Wide z = multiply_add(y, h * series, y);
  return x * z * z;
}

inline bool any_outside(Wide x, double low, double high) {
#if defined(__AVX512F__)
  return _mm512_cmp_pd_mask((__m512d)x, _mm512_set1_pd(low), _CMP_LT_OQ) |
         _mm512_cmp_pd_mask((__m512d)x, _mm512_set1_pd(high), _CMP_GT_OQ);
#else
  bool outside = false;
  for (int l = 0; l < native_lanes; ++l) {
    outside |= (x[l] < low) | (x[l] > high);
  }
  return outside;
#endif
}

/// x^(1/3) to a few units in the last place. Volume ratios are near 1: there a polynomial of degree 5 (least relative error
/// over [1/2, 2], 3.3e-4) gives x^(-1/3), and one step of the series above up to h^4 does the rest.
inline Wide cube_root(Wide x) {
  if (__builtin_expect(any_outside(x, 0.5, 2.0), 0)) {
    return cube_root_of_any(x);
  }
  const Wide t = x - 1.0;
  Wide y = splat<Wide>(-0.07066835568187121);
  for (const double c : {0.17781975688620016, -0.20453628969115334, 0.22143791401899482, -0.33058278061251845,
                         0.9999736554168059}) {
    y = multiply_add(y, t, splat<Wide>(c));
  }
  const Wide h = subtract_product(splat<Wide>(1.0), x * y, y * y);
  Wide series = splat<Wide>(35.0 / 243.0);
  for (const double c : {14.0 / 81.0, 2.0 / 9.0, 1.0 / 3.0}) {
    series = multiply_add(series, h, splat<Wide>(c));
  }
  const Wide z = multiply_add(y, h * series, y);
  return x * z * z;
}

} // namespace
