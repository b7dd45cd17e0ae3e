// SPDX-License-Identifier: GPL-3.0-or-later
// The contact pass, for any contact law: kernels.cpp makes it for those of bpm/laws, once for each instruction set; a
// program with a law of its own makes it for that (outside_contact_law.h).
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"

#include <cstdint>
#include <type_traits>

namespace boba::kernels {
namespace {

template <class Coordinate, class Real>
void collect_nodes(const std::int32_t* nodes, std::int64_t n, const Coordinate* x, const Real* v, int stride,
                   const double* origin, double quantum, ContactNode* to) {
  for (std::int64_t k = 0; k < n; ++k) {
    const std::int64_t from = 3 * static_cast<std::int64_t>(nodes[k]) * stride;
    ContactNode& node = to[nodes[k]];
    for (int c = 0; c < 3; ++c) {
      if constexpr (std::is_same_v<Coordinate, std::int32_t>) {
        node.x[c] = origin[c] + quantum * x[from + c * stride];
      } else {
        node.x[c] = x[from + c * stride];
      }
      node.v[c] = v[from + c * stride];
    }
    node.filling[0] = node.filling[1] = 0.0;
  }
}

/// Candidates ahead of the present one whose second node is asked for: it lies anywhere, where no hardware prefetch
/// finds it.
constexpr std::int64_t prefetch_distance = 16;

inline void prefetch_ahead(const ContactCandidates& c, std::int64_t e) {
  __builtin_prefetch(&c.second[c.pairs[e + prefetch_distance < c.n ? e + prefetch_distance : c.n - 1].j]);
}

/// Position and velocity of a contact node in one vector: x y z vx vy vz 0 0.
using NodeRow = Vector<double, 8>;

/// Writes down the candidates closer than sqrt(reach2), in order and without a branch, and returns their number.
inline std::int64_t near_candidates(const ContactCandidates& c, double reach2, NodePair* near) {
  std::int64_t n = 0;
  for (std::int64_t e = 0; e < c.n; ++e) {
    prefetch_ahead(c, e);
    const NodePair pair = c.pairs[e];
    const double* a = c.first[pair.i].x;
    const double* b = c.second[pair.j].x;
    const double dx = a[0] - b[0] - c.shift[0];
    const double dy = a[1] - b[1] - c.shift[1];
    const double dz = a[2] - b[2] - c.shift[2];
    near[n] = pair;
    n += dx * dx + dy * dy + dz * dz < reach2;
  }
  return n;
}

/// Writes down the candidates that touch, and x_i - x_j, v_i - v_j of each as a row, in order and without a branch.
inline std::int64_t touching_rows(const ContactCandidates& c, double range, ContactNode* rows, Touch* touches) {
  const NodeRow shift = {c.shift[0],          c.shift[1],          c.shift[2], c.shift_velocity[0],
                         c.shift_velocity[1], c.shift_velocity[2], 0.0,        0.0};
  const double reach2 = range * range;
  std::int64_t n = 0;
  for (std::int64_t e = 0; e < c.n; ++e) {
    prefetch_ahead(c, e);
    const NodePair pair = c.pairs[e];
    const NodeRow d = load<NodeRow>(c.first[pair.i].x) - load<NodeRow>(c.second[pair.j].x) - shift;
    store<NodeRow>(rows[n].x, d);
    touches[n].nodes = pair;
    n += d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach2;
  }
  return n;
}

/// Forces of as many touches as a register holds, and their share of the sums.
struct TouchSums {
  Wide virial[6]{}, smallest_r2, potential{};
};

/// As many touches as a register holds.
struct TouchRegister {
  Wide force[3], virial[6], r2, potential;
};
template <class Law> inline TouchRegister evaluate_rows(const ContactNode* rows, const Law& law) {
  Wide d[3], approach{};
  for (int l = 0; l < native_lanes; ++l) {
    for (int c = 0; c < 3; ++c) {
      d[c][l] = rows[l].x[c];
    }
    approach[l] = rows[l].x[0] * rows[l].v[0] + rows[l].x[1] * rows[l].v[1] + rows[l].x[2] * rows[l].v[2];
  }
  const Wide r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  const Wide inverse_r = inverse_sqrt(r2), r = r2 * inverse_r;
  const Wide s = law.force(r, approach * inverse_r) * inverse_r;
  const Wide f[3] = {s * d[0], s * d[1], s * d[2]};
  return {{f[0], f[1], f[2]},
          {f[0] * d[0], f[1] * d[1], f[2] * d[2], f[0] * d[1], f[0] * d[2], f[1] * d[2]},
          r2,
          law.energy(r)};
}

template <class Law>
inline void evaluate_touches(const ContactNode* rows, const Law& law, Touch* touches, TouchSums& sums) {
  const TouchRegister touch = evaluate_rows(rows, law);
  for (int l = 0; l < native_lanes; ++l) {
    for (int c = 0; c < 3; ++c) {
      touches[l].force[c] = touch.force[c][l];
    }
  }
  for (int c = 0; c < 6; ++c) {
    sums.virial[c] += touch.virial[c];
  }
  sums.smallest_r2 = touch.r2 < sums.smallest_r2 ? touch.r2 : sums.smallest_r2;
  sums.potential += touch.potential;
}

/// The sums follow from the touches alone, whatever other candidates there were.
template <class Law>
std::int64_t contact_forces(const ContactCandidates& candidates, const Law& law, ContactNode* rows, Touch* touches,
                            ContactSums& sums) {
  const std::int64_t n = touching_rows(candidates, law.range(), rows, touches);
  if (n == 0) {
    return 0;
  }
  for (std::int64_t t = n; t % native_lanes != 0; ++t) { // nodes that just do not touch fill the last register
    rows[t] = {{law.range(), 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0}};
  }
  TouchSums wide;
  wide.smallest_r2 = splat<Wide>(law.range() * law.range());
  for (std::int64_t t = 0; t < n; t += native_lanes) {
    evaluate_touches(rows + t, law, touches + t, wide);
  }
  for (int c = 0; c < 6; ++c) {
    sums.virial[c] = sum_of(wide.virial[c]);
  }
  sums.smallest_r2 = -largest_of(-wide.smallest_r2);
  sums.potential = sum_of(wide.potential);
  sums.n_touching = n;
  return n;
}

template <class Real> void add_touches(const Touch* touches, std::int64_t n, double sign, Real* f, int stride) {
  for (std::int64_t t = 0; t < n; ++t) {
    const NodePair& nodes = touches[t].nodes;
    Real* to = f + 3 * static_cast<std::int64_t>(sign > 0.0 ? nodes.i : nodes.j) * stride;
    for (int c = 0; c < 3; ++c) {
      to[c * stride] += static_cast<Real>(sign * touches[t].force[c]);
    }
  }
}

} // namespace
} // namespace boba::kernels
