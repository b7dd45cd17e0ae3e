// SPDX-License-Identifier: GPL-3.0-or-later
// The contact pass for grains of one node, for any contact law; made where contact_kernel.h is.
#pragma once

#include "bpm/forces/kernels/contact_kernel.h"

#include <cstdint>

namespace boba::kernels {
namespace {

using PointVector = Vector<double, 4>;

inline PointVector between(const PointCandidates& c, const PointVector& a, std::int64_t e) {
  return a - load<PointVector>(c.x[c.other[e]].x) - load<PointVector>(c.image_shift[c.image[e]].x);
}

/// x^2 + y^2 + z^2 of four.
inline PointVector squared_lengths(PointVector a, PointVector b, PointVector c, PointVector d) {
  a *= a;
  b *= b;
  c *= c;
  d *= d;
  const PointVector xz_ab = __builtin_shufflevector(a, b, 0, 4, 2, 6), y_ab = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const PointVector xz_cd = __builtin_shufflevector(c, d, 0, 4, 2, 6), y_cd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(xz_ab, xz_cd, 0, 1, 4, 5) + __builtin_shufflevector(y_ab, y_cd, 0, 1, 4, 5) +
         __builtin_shufflevector(xz_ab, xz_cd, 2, 3, 6, 7);
}

/// Writes down the candidates that touch, in order and without a branch; last[node] is the end of a node's.
inline std::int32_t touching_candidates(const PointCandidates& c, double range, std::int32_t* touching,
                                        std::int32_t* last) {
  const double reach2 = range * range;
  std::int32_t n = 0;
  for (std::int32_t node = 0; node < c.n_nodes; ++node) {
    const PointVector a = load<PointVector>(c.x[c.begin + node].x);
    std::int32_t e = c.first[node];
    for (; e + 4 <= c.first[node + 1]; e += 4) {
      const Vector<std::int64_t, 4> is_near =
          squared_lengths(between(c, a, e), between(c, a, e + 1), between(c, a, e + 2), between(c, a, e + 3)) < reach2;
      for (std::int32_t l = 0; l < 4; ++l) { // a true comparison is -1
        touching[n] = e + l;
        n -= static_cast<std::int32_t>(is_near[l]);
      }
    }
    for (; e < c.first[node + 1]; ++e) {
      const PointVector d = between(c, a, e), squares = d * d;
      touching[n] = e;
      n += squares[0] + squares[1] + squares[2] < reach2;
    }
    last[node] = n;
  }
  return n;
}

/// Evaluates the touches a register at a time; term c of touch t is terms[c stride + t].
template <class Law>
inline void evaluate_points(const PointCandidates& c, const Law& law, std::int32_t n, const std::int32_t* touching,
                            const std::int32_t* last, double* terms, std::int64_t stride) {
  std::int32_t node = 0;
  for (std::int32_t t = 0; t < n; t += native_lanes) {
    ContactNode rows[native_lanes];
    for (int l = 0; l < native_lanes; ++l) {
      if (t + l >= n) { // nodes that just do not touch fill the last register
        rows[l] = {{law.range(), 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0}};
        continue;
      }
      while (t + l >= last[node]) {
        ++node;
      }
      const std::int32_t e = touching[t + l];
      const PointVector d = between(c, load<PointVector>(c.x[c.begin + node].x), e);
      const PointVector u = load<PointVector>(c.v[c.begin + node].x) - load<PointVector>(c.v[c.other[e]].x) -
                            load<PointVector>(c.image_velocity[c.image[e]].x);
      for (int k = 0; k < 3; ++k) {
        rows[l].x[k] = d[k];
        rows[l].v[k] = u[k];
      }
    }
    const TouchRegister touch = evaluate_rows(rows, law);
    for (int k = 0; k < 3; ++k) {
      store<Wide>(terms + k * stride + t, touch.force[k]);
    }
    for (int k = 0; k < 6; ++k) {
      store<Wide>(terms + (3 + k) * stride + t, touch.virial[k]);
    }
    store<Wide>(terms + 9 * stride + t, touch.potential);
    store<Wide>(terms + 10 * stride + t, touch.r2);
  }
}

/// Adds the terms of touches [begin, end), half of those that two nodes share.
inline void sum_points(const double* terms, std::int64_t stride, std::int32_t begin, std::int32_t end,
                       const PointSumming& how, PointSums& sums) {
  if (how.in_floats) {
    for (int k = 0; k < 3; ++k) {
      float f = 0.0F;
      for (std::int32_t t = begin; t < end; ++t) {
        f += static_cast<float>(terms[k * stride + t]);
      }
      sums.force[k] = f;
    }
  } else {
    for (int k = 0; k < 3; ++k) {
      double f = 0.0;
      for (std::int32_t t = begin; t < end; ++t) {
        f += terms[k * stride + t];
      }
      sums.force[k] = f;
    }
  }
  if (!how.with_contacts) {
    return;
  }
  double halves[7];
  for (int k = 0; k < 7; ++k) {
    halves[k] = 0.0;
    for (std::int32_t t = begin; t < end; ++t) {
      halves[k] += 0.5 * terms[(3 + k) * stride + t];
    }
  }
  for (int k = 0; k < 6; ++k) {
    sums.contacts.virial[k] = halves[k];
  }
  sums.contacts.potential = halves[6];
  double smallest_r2 = sums.contacts.smallest_r2;
  for (std::int32_t t = begin; t < end; ++t) {
    const double r2 = terms[10 * stride + t];
    smallest_r2 = r2 < smallest_r2 ? r2 : smallest_r2;
  }
  sums.contacts.smallest_r2 = smallest_r2;
  sums.contacts.n_touching = end - begin;
}

template <class Law>
void point_contact_forces(const PointCandidates& candidates, const Law& law, const PointSumming& how,
                          const PointScratch& scratch, PointSums* sums) {
  const std::int32_t* last = scratch.last;
  const std::int32_t n = touching_candidates(candidates, law.range(), scratch.touching, scratch.last);
  evaluate_points(candidates, law, n, scratch.touching, last, scratch.terms, scratch.stride);
  for (std::int32_t node = 0; node < candidates.n_nodes; ++node) {
    sum_points(scratch.terms, scratch.stride, node > 0 ? last[node - 1] : 0, last[node], how, sums[node]);
  }
}

} // namespace
} // namespace boba::kernels
