// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"

#include <cstdint>

namespace boba::kernels {
namespace {

/// The whole number below x, lane by lane.
template <class I, class V> inline I rounded_down(V x) {
  const I towards_zero = converted<I>(x);
  if constexpr (lanes_of<V> == 1) {
    return towards_zero - (converted<V>(towards_zero) > x);
  } else {
    return towards_zero + (converted<V>(towards_zero) > x); // a true comparison is -1
  }
}

/// 64 bits that look random for every number. Source: G. L. Steele, D. Lea & C. H. Flood, "Fast splittable pseudorandom
/// number generators", OOPSLA 2014 (SplitMix64).
inline std::uint64_t random_bits(std::uint64_t number) {
  std::uint64_t z = number * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

/// Square of a speed that nothing reaches, d^2/tau^2.
constexpr double nobody = 1e30;

/// Doubles: x <- map x + shift + dt v. Fixed point: the origin follows the map outside, the coordinates move by
/// (map - 1) x + dt v, rounded up or down to quanta with the odds that make the mean exact, drawn again for every step,
/// node and component: however slow a drift, none of it is lost. (A sequence that only fills (0, 1) evenly will not do:
/// velocities answer to the last rounding, and grains creep.)
template <class S, bool mapped, class Coordinate = typename S::Coordinate, class Real = typename S::Real>
void drift_lanes(Coordinate* x, const Real* v, int n_nodes, const Drift& drift, int lane, typename S::V& speed2,
                 typename S::V& checksum, std::int32_t& n_fast) {
  using V = typename S::V;
  using P = typename S::P;
  constexpr std::int64_t stride = S::stride;
  const V q = splat<V>(drift.quantum), dt = splat<V>(drift.dt);
  const V per_quantum = splat<V>(S::fixed_point ? 1.0 / drift.quantum : 1.0);
  const V fast_speed2 = splat<V>(drift.fast != nullptr ? drift.fast_speed2 : nobody);
  V residual_shift = splat<V>(drift.residual_shift);
  if constexpr (S::fixed_point) {
    residual_shift = load_doubles<V>(drift.lane_shift + lane);
  }
  V m[3][3];
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      m[row][column] = splat<V>(drift.map[row][column] - (S::fixed_point && row == column ? 1.0 : 0.0));
    }
  }
  for (std::int64_t node = 0; node < n_nodes; ++node) {
    Coordinate* at = x + 3 * node * stride + lane;
    const Real* va = v + 3 * node * stride + lane;
    const std::uint64_t draw =
        S::fixed_point ? random_bits(drift.dither_seed + static_cast<std::uint64_t>(drift.first_node + node)) : 0;
    P place[3];
    V p[3], u[3];
    for (int c = 0; c < 3; ++c) {
      place[c] = load<P>(at + c * stride);
      p[c] = S::value(place[c], q);
      u[c] = load<V>(va + c * stride);
    }
    for (int c = 0; c < 3; ++c) {
      if constexpr (S::fixed_point) {
        V move = dt * u[c];
        if constexpr (mapped) {
          move += m[c][0] * p[0] + m[c][1] * p[1] + m[c][2] * p[2];
        }
        const V odds = splat<V>((static_cast<double>(draw >> (21 * c) & 0x1fffff) + 0.5) / 0x200000);
        store<P>(at + c * stride, place[c] + rounded_down<P>(multiply_add(move, per_quantum, odds)));
      } else {
        const V moved = mapped ? m[c][0] * p[0] + m[c][1] * p[1] + m[c][2] * p[2] + splat<V>(drift.shift[c]) : p[c];
        store<V>(at + c * stride, moved + dt * u[c]);
      }
    }
    checksum += u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    u[0] -= splat<V>(drift.residual[0]) * p[0] + splat<V>(drift.residual[1]) * p[1] +
            splat<V>(drift.residual[2]) * p[2] + residual_shift;
    const V own_speed2 = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    speed2 = larger(speed2, own_speed2);
    if (__builtin_expect(any_above(own_speed2, fast_speed2), 0)) {
      drift.fast[n_fast++] = static_cast<std::int32_t>(node);
    }
  }
}

template <class Coordinate, class Real>
DriftResult drift_block(Coordinate* x, const Real* v, int n_nodes, int n_lanes, const Drift& drift) {
  DriftResult result{};
  for_lanes<Coordinate>(n_lanes, [&](int lane, auto storage) {
    using S = decltype(storage);
    typename S::V speed2{}, checksum{};
    if (drift.mapped) {
      drift_lanes<S, true>(x, v, n_nodes, drift, lane, speed2, checksum, result.n_fast);
    } else {
      drift_lanes<S, false>(x, v, n_nodes, drift, lane, speed2, checksum, result.n_fast);
    }
    const double largest = largest_of(speed2);
    result.largest_speed2 = largest > result.largest_speed2 ? largest : result.largest_speed2;
    result.checksum += sum_of(checksum);
  });
  return result;
}

} // namespace
} // namespace boba::kernels
