// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only. The law itself is in bpm/laws/contact.h.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/laws/contact.h"

#include <cmath>
#include <type_traits>

namespace {

using boba::kernels::ContactCandidates;
using boba::kernels::ContactNode;
using boba::kernels::ContactParameters;
using boba::kernels::ContactSums;
using boba::kernels::NodePair;
using boba::kernels::Touch;

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
  }
}

/// Candidates ahead of the present one whose second node is asked for: it lies anywhere, where no hardware prefetch
/// finds it.
constexpr std::int64_t prefetch_distance = 16;

/// Writes down the candidates that touch, in order and without a branch, and returns their number. The squared distance
/// waits in force[0].
inline std::int64_t touching_pairs(const ContactCandidates& c, double diameter, Touch* __restrict touches) {
  const double reach2 = diameter * diameter;
  const std::int64_t last = c.n - 1;
  std::int64_t n = 0;
  for (std::int64_t e = 0; e < c.n; ++e) {
    __builtin_prefetch(&c.second[c.pairs[e + prefetch_distance < last ? e + prefetch_distance : last].j]);
    const NodePair pair = c.pairs[e];
    const double* a = c.first[pair.i].x;
    const double* b = c.second[pair.j].x;
    const double dx = a[0] - b[0] - c.shift[0];
    const double dy = a[1] - b[1] - c.shift[1];
    const double dz = a[2] - b[2] - c.shift[2];
    const double r2 = dx * dx + dy * dy + dz * dz;
    touches[n].nodes = pair;
    touches[n].force[0] = r2;
    n += r2 < reach2;
  }
  return n;
}

/// Replaces the squared distance by the force on node i.
inline void evaluate_touch(const ContactCandidates& candidates, const ContactParameters& p, Touch& touch,
                           bool with_sums, ContactSums& sums) {
  const ContactNode& a = candidates.first[touch.nodes.i];
  const ContactNode& b = candidates.second[touch.nodes.j];
  const double r2 = touch.force[0];
  double d[3], approach = 0.0;
  for (int c = 0; c < 3; ++c) {
    d[c] = a.x[c] - b.x[c] - candidates.shift[c];
    approach += d[c] * (a.v[c] - b.v[c] - candidates.shift_velocity[c]);
  }
  const double r = std::sqrt(r2), inverse_r = 1.0 / r;
  const double s = boba::contact_force(p.k, p.k3, p.gamma, p.diameter, r, approach * inverse_r) * inverse_r;
  for (int c = 0; c < 3; ++c) {
    touch.force[c] = s * d[c];
  }
  if (with_sums) {
    sums.virial[0] += s * d[0] * d[0];
    sums.virial[1] += s * d[1] * d[1];
    sums.virial[2] += s * d[2] * d[2];
    sums.virial[3] += s * d[0] * d[1];
    sums.virial[4] += s * d[0] * d[2];
    sums.virial[5] += s * d[1] * d[2];
    sums.smallest_r2 = r2 < sums.smallest_r2 ? r2 : sums.smallest_r2;
    sums.potential += boba::contact_energy(p.k, p.k3, p.diameter, r);
  }
}

std::int64_t contact_forces(const ContactCandidates& candidates, const ContactParameters& p, Touch* touches,
                            bool with_sums, ContactSums& sums) {
  const std::int64_t n = touching_pairs(candidates, p.diameter, touches);
  for (std::int64_t t = 0; t < n; ++t) {
    evaluate_touch(candidates, p, touches[t], with_sums, sums);
  }
  sums.n_touching += n;
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
