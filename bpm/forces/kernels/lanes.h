// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only, once for each instruction set: everything here lives in an unnamed namespace of its
// own.
#pragma once

#include "bpm/laws/law_function.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <type_traits>
#include <utility>

#if defined(__AVX2__)
#include <immintrin.h>
#endif

namespace boba::kernels {
namespace {

#if defined(__AVX512F__)
constexpr int native_lanes = 8;
#elif defined(__AVX2__)
constexpr int native_lanes = 4;
#else
constexpr int native_lanes = 2;
#endif

/// Vectors of N numbers; + - * / and comparisons act lane by lane.
template <class T, int N> struct VectorOf { using Type __attribute__((vector_size(sizeof(T) * N))) = T; };
template <class T> struct VectorOf<T, 1> { using Type = T; };
template <class T, int N> using Vector = typename VectorOf<T, N>::Type;

/// The widest register of doubles of this instruction set, that of floats, and as many floats as there are doubles.
using Wide = Vector<double, native_lanes>;
using WideFloat = Vector<float, native_lanes>;
using WideSingle = Vector<float, 2 * native_lanes>;

template <class V> constexpr int lanes_of = sizeof(V) / sizeof(std::declval<V>()[0]);
template <> constexpr int lanes_of<double> = 1;
template <> constexpr int lanes_of<float> = 1;
template <> constexpr int lanes_of<std::int32_t> = 1;

/// The number type of a vector, and vectors of other types with as many lanes.
template <class V> struct ElementOf { using Type = std::remove_cvref_t<decltype(std::declval<V>()[0])>; };
template <> struct ElementOf<double> { using Type = double; };
template <> struct ElementOf<float> { using Type = float; };
template <class V> using Element = typename ElementOf<V>::Type;
template <class V> using IntsOf = Vector<std::int32_t, lanes_of<V>>;
template <class V> using DoublesOf = Vector<double, lanes_of<V>>;

template <class To, class From> inline To converted(From from) {
  if constexpr (lanes_of<To> == 1) {
    return static_cast<To>(from);
  } else {
    return __builtin_convertvector(from, To);
  }
}

template <class V, class T> inline V load(const T* from) {
  V value;
  std::memcpy(&value, from, sizeof(V));
  return value;
}
template <class V, class T> inline void store(T* to, V value) {
  std::memcpy(to, &value, sizeof(V));
}

template <class V> inline V splat(double value) {
  if constexpr (lanes_of<V> == 1) {
    return static_cast<V>(value);
  } else {
    return static_cast<Element<V>>(value) - V{};
  }
}

/// a * b + c and c - a * b, fused where the machine can. Written out because the compiler is told not to contract by
/// itself: two versions of a loop (with and without a virial) must give the same forces to the last bit.
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
inline float multiply_add(float a, float b, float c) {
#if defined(__FMA__)
  return __builtin_fmaf(a, b, c);
#else
  return a * b + c;
#endif
}
inline WideSingle multiply_add(WideSingle a, WideSingle b, WideSingle c) {
#if defined(__AVX512F__)
  return (WideSingle)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
#elif defined(__FMA__)
  return (WideSingle)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
  return a * b + c;
#endif
}
inline WideFloat multiply_add(WideFloat a, WideFloat b, WideFloat c) {
#if defined(__AVX512F__)
  return (WideFloat)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
#else
  return a * b + c;
#endif
}
template <class V> inline V subtract_product(V c, V a, V b) {
#if defined(__AVX512F__) // the compiler would flip the sign in an instruction of its own
  if constexpr (std::is_same_v<V, Wide>) {
    return (Wide)_mm512_fnmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
  } else if constexpr (std::is_same_v<V, WideSingle>) {
    return (WideSingle)_mm512_fnmadd_ps((__m512)a, (__m512)b, (__m512)c);
  }
#endif
  return multiply_add(-a, b, c);
}

template <class V> inline V larger(V a, V b) {
  return a > b ? a : b;
}

template <class V> inline double sum_of(V v) {
  if constexpr (lanes_of<V> == 1) {
    return v;
  } else {
    double sum = 0.0;
    for (int l = 0; l < lanes_of<V>; ++l) {
      sum += v[l];
    }
    return sum;
  }
}
template <class V> inline double largest_of(V v) {
  if constexpr (lanes_of<V> == 1) {
    return v;
  } else {
    double largest = v[0];
    for (int l = 1; l < lanes_of<V>; ++l) {
      largest = largest > v[l] ? largest : v[l];
    }
    return largest;
  }
}

inline double inverse_sqrt(double x) {
  return 1.0 / std::sqrt(x);
}

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
  Wide y = __builtin_convertvector((WideFloat)_mm_rsqrt_ps((__m128) __builtin_convertvector(x, WideFloat)), Wide);
  y = y * subtract_product(splat<Wide>(1.5), 0.5 * x * y, y);
  const Wide h = subtract_product(splat<Wide>(1.0), x * y, y);
  return multiply_add(y, h * multiply_add(h, splat<Wide>(0.375), splat<Wide>(0.5)), y);
#else
  Wide y{};
  for (int l = 0; l < native_lanes; ++l) {
    y[l] = 1.0 / std::sqrt(x[l]);
  }
  return y;
#endif
}

inline float inverse_sqrt(float x) {
  return 1.0f / std::sqrt(x);
}

/// One step on the hardware's estimate of 1/sqrt(x): to about one unit in a float's last place.
template <class V> inline V improved_inverse_sqrt(V x, V y) {
  return y * subtract_product(splat<V>(1.5), 0.5f * x * y, y);
}
inline WideSingle inverse_sqrt(WideSingle x) {
#if defined(__AVX512F__)
  return improved_inverse_sqrt(x, (WideSingle)_mm512_maskz_rsqrt14_ps(0xffff, (__m512)x));
#elif defined(__AVX2__)
  return improved_inverse_sqrt(x, (WideSingle)_mm256_rsqrt_ps((__m256)x));
#else
  WideSingle y{};
  for (int l = 0; l < 2 * native_lanes; ++l) {
    y[l] = 1.0f / std::sqrt(x[l]);
  }
  return y;
#endif
}
inline WideFloat inverse_sqrt(WideFloat x) {
#if defined(__AVX512F__)
  return improved_inverse_sqrt(x, (WideFloat)_mm256_maskz_rsqrt14_ps(0xff, (__m256)x));
#else
  WideFloat y{};
  for (int l = 0; l < native_lanes; ++l) {
    y[l] = 1.0f / std::sqrt(x[l]);
  }
  return y;
#endif
}

inline double cube_root(double x) {
  return std::cbrt(x);
}
inline float cube_root(float x) {
  return std::cbrt(x);
}

/// Bounds that a float holds.
template <class V> inline bool any_outside(V x, double low, double high) {
  if constexpr (lanes_of<V> == 1) {
    return (x < low) | (x > high);
  } else {
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<V, Wide>) {
      return !_kortestz_mask8_u8(_mm512_cmp_pd_mask((__m512d)x, _mm512_set1_pd(low), _CMP_LT_OQ),
                                 _mm512_cmp_pd_mask((__m512d)x, _mm512_set1_pd(high), _CMP_GT_OQ));
    }
    if constexpr (std::is_same_v<V, WideSingle>) {
      return !_kortestz_mask16_u8(_mm512_cmp_ps_mask((__m512)x, _mm512_set1_ps(static_cast<float>(low)), _CMP_LT_OQ),
                                  _mm512_cmp_ps_mask((__m512)x, _mm512_set1_ps(static_cast<float>(high)), _CMP_GT_OQ));
    }
#endif
    return holds_in_any((x < splat<V>(low)) | (x > splat<V>(high)));
  }
}

/// True also where x is not a number.
template <class V> inline bool any_above(V x, V limit) {
  if constexpr (lanes_of<V> == 1) {
    return !(x <= limit);
  } else {
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<V, Wide>) {
      return _mm512_cmp_pd_mask((__m512d)x, (__m512d)limit, _CMP_NLE_UQ) != 0;
    }
    if constexpr (std::is_same_v<V, WideSingle>) {
      return _mm512_cmp_ps_mask((__m512)x, (__m512)limit, _CMP_NLE_UQ) != 0;
    }
#endif
    return holds_in_any(~(x <= limit));
  }
}

/// True when a and b are not the same in some lane.
template <class V> inline bool any_different(V a, V b) {
  if constexpr (lanes_of<V> == 1) {
    return a != b;
  } else {
#if defined(__AVX512F__)
    if constexpr (std::is_same_v<V, Wide>) {
      return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_NEQ_UQ) != 0;
    }
    if constexpr (std::is_same_v<V, WideSingle>) {
      return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_NEQ_UQ) != 0;
    }
#endif
    return holds_in_any(a != b);
  }
}

/// x^(-1/3) to 3.3e-4 over [1/2, 2]: the polynomial of degree 5 with the least relative error.
template <class V> inline V near_inverse_cube_root(V x) {
  const V t = x - static_cast<Element<V>>(1.0);
  V y = splat<V>(-0.07066835568187121);
  for (const double c :
       {0.17781975688620016, -0.20453628969115334, 0.22143791401899482, -0.33058278061251845, 0.9999736554168059}) {
    y = multiply_add(y, t, splat<V>(c));
  }
  return y;
}

/// The library's root where x is outside [1/2, 2], and `root` elsewhere. Lane by lane: what one grain computes must not
/// depend on which others share its register.
template <class V> __attribute__((noinline, cold)) V with_far_lanes(V x, V root) {
  for (int l = 0; l < lanes_of<V>; ++l) {
    if (x[l] < 0.5 || x[l] > 2.0) {
      root[l] = std::cbrt(x[l]);
    }
  }
  return root;
}

/// x^(1/3) to about a unit in the last place. Volume ratios are near 1: there a polynomial gives y = x^(-1/3) roughly,
/// and
///     x^(1/3) = x y^2 (1 - h)^(-2/3),  h = 1 - x y^3,  (1 - h)^(-2/3) = 1 + 2h/3 + 5h^2/9 + 40h^3/81 + 110h^4/243 +
///     ...
/// up to h^2 for floats and h^4 for doubles.
template <class V> inline V near_cube_root(V x, std::initializer_list<double> series) {
  const V y = near_inverse_cube_root(x);
  const V xyy = x * y * y;
  const V h = subtract_product(splat<V>(1.0), xyy, y);
  V sum = splat<V>(*series.begin());
  for (const double* c = series.begin() + 1; c != series.end(); ++c) {
    sum = multiply_add(sum, h, splat<V>(*c));
  }
  return multiply_add(xyy, h * sum, xyy);
}
inline Wide cube_root(Wide x) {
  const Wide root = near_cube_root(x, {110.0 / 243.0, 40.0 / 81.0, 5.0 / 9.0, 2.0 / 3.0});
  return __builtin_expect(any_outside(x, 0.5, 2.0), 0) ? with_far_lanes(x, root) : root;
}
template <class V> inline V cube_root_single(V x) {
  const V root = near_cube_root(x, {5.0 / 9.0, 2.0 / 3.0});
  return __builtin_expect(any_outside(x, 0.5, 2.0), 0) ? with_far_lanes(x, root) : root;
}
inline WideSingle cube_root(WideSingle x) {
  return cube_root_single(x);
}
inline WideFloat cube_root(WideFloat x) {
  return cube_root_single(x);
}

/// How lane arrays are stored and computed with. V: the numbers of some lanes; P: as many coordinates; stride: lanes of
/// the block, a constant so that addresses cost no instructions.
template <class V_, class Coordinate_, int stride_> struct Storage {
  using V = V_;
  static constexpr std::int64_t stride = stride_;
  using Coordinate = Coordinate_;
  using Real = Element<V>;
  static constexpr bool fixed_point = std::is_same_v<Coordinate, std::int32_t>;
  using P = std::conditional_t<fixed_point, Vector<std::int32_t, lanes_of<V>>, V>;

  /// a - b in units of the coordinates: quanta or d. Integers are subtracted exactly before they become floats.
  static V distance(P a, P b) {
    if constexpr (fixed_point) {
      return converted<V>(a - b);
    } else {
      return a - b;
    }
  }
  /// A length in units of the coordinates, in d. The quantum is a power of two: nothing is rounded.
  static V in_diameters(V length, V quantum) {
    if constexpr (fixed_point) {
      return length * quantum;
    } else {
      return length;
    }
  }
  /// The coordinate itself, d.
  static V value(P a, V quantum) {
    if constexpr (fixed_point) {
      return converted<V>(a) * quantum;
    } else {
      return a;
    }
  }
};

/// Calls visit(lane, Storage) for every run of lanes that fills a register of V in a block of n lanes.
template <class V, class Coordinate, int n, class Visit> inline void for_registers(Visit&& visit) {
  for (int lane = 0; lane < n; lane += lanes_of<V>) {
    visit(lane, Storage<V, Coordinate, n>{});
  }
}

/// The same for a block whose number of lanes is known only now: 1 or 8, in mixed precision also 16.
template <class Coordinate, class Visit> inline void for_lanes(int n_lanes, Visit&& visit) {
  constexpr bool mixed = std::is_same_v<Coordinate, std::int32_t>;
  if (n_lanes == 1) {
    for_registers<std::conditional_t<mixed, float, double>, Coordinate, 1>(visit);
  } else if constexpr (!mixed) {
    for_registers<Wide, Coordinate, 8>(visit);
  } else if (n_lanes == 16) {
    for_registers<WideSingle, Coordinate, 16>(visit);
  } else if constexpr (native_lanes == 8) { // eight floats in half a register
    for_registers<WideFloat, Coordinate, 8>(visit);
  } else {
    for_registers<WideSingle, Coordinate, 8>(visit);
  }
}

/// Numbers of the lanes as V, from doubles and back.
template <class V> inline V load_doubles(const double* from) {
  return converted<V>(load<DoublesOf<V>>(from));
}
template <class V> inline void store_doubles(double* to, V value) {
  store<DoublesOf<V>>(to, converted<DoublesOf<V>>(value));
}

} // namespace
} // namespace boba::kernels
