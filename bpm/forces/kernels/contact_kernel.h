// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only. The law itself is in bpm/laws/contact.h.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/laws/contact.h"

#include <cmath>

namespace {

using boba::kernels::ContactForce;
using boba::kernels::ContactNode;
using boba::kernels::ContactParameters;
using boba::kernels::ContactRows;
using boba::kernels::ContactSource;
using boba::kernels::ContactSums;

void collect_nodes(const ContactSource* sources, std::int64_t n, const double* x, const double* v, int stride,
                   ContactNode* nodes) {
  for (std::int64_t s = 0; s < n; ++s) {
    const double* xs = x + sources[s].from;
    const double* vs = v + sources[s].from;
    ContactNode& node = nodes[sources[s].slot];
    for (int c = 0; c < 3; ++c) {
      node.x[c] = xs[c * stride];
      node.v[c] = vs[c * stride];
    }
  }
}

void scatter_forces(const ContactSource* sources, std::int64_t n, const ContactForce* force, double* f, int stride) {
  for (std::int64_t s = 0; s < n; ++s) {
    const double* from = force[sources[s].slot].f;
    double* to = f + sources[s].from;
    for (int c = 0; c < 3; ++c) {
      to[c * stride] += from[c];
    }
  }
}

/// Candidates ahead of the present one whose other node is asked for: it lies anywhere, where no hardware prefetch finds it.
constexpr std::int64_t prefetch_distance = 16;

/// Squared distances of all candidates; those that touch are written down in list order, without a branch.
inline std::int64_t touching_pairs(const ContactRows& rows, const ContactNode* nodes, const ContactParameters& p,
                                   double* __restrict r2, std::int32_t* __restrict touching) {
  const double reach2 = p.diameter * p.diameter;
  const std::int64_t last = rows.n - 1;
  std::int64_t n = 0;
  for (std::int64_t e = 0; e < rows.n; ++e) {
    __builtin_prefetch(&nodes[rows.other[e + prefetch_distance < last ? e + prefetch_distance : last]]);
    const double* a = nodes[rows.own[e]].x;
    const double* b = nodes[rows.other[e]].x;
    const double* shift = p.shift + 3 * rows.image[e];
    const double dx = a[0] - b[0] - shift[0];
    const double dy = a[1] - b[1] - shift[1];
    const double dz = a[2] - b[2] - shift[2];
    const double square = dx * dx + dy * dy + dz * dz;
    r2[n] = square;
    touching[n] = static_cast<std::int32_t>(e);
    n += square < reach2;
  }
  return n;
}

/// The force of one touching pair, added to its own node's sum in list order (a fixed order: results do not depend on
/// threads).
inline void add_contact(const ContactRows& rows, std::int64_t e, const ContactNode* nodes, ContactForce* force,
                        const ContactParameters& p, double r2, bool with_sums, ContactSums& sums) {
  const ContactNode& a = nodes[rows.own[e]];
  const ContactNode& b = nodes[rows.other[e]];
  const double* shift = p.shift + 3 * rows.image[e];
  const double* shift_velocity = p.shift_velocity + 3 * rows.image[e];
  double d[3], approach = 0.0;
  for (int c = 0; c < 3; ++c) {
    d[c] = a.x[c] - b.x[c] - shift[c];
    approach += d[c] * (a.v[c] - b.v[c] - shift_velocity[c]);
  }
  const double r = std::sqrt(r2), inverse_r = 1.0 / r;
  const double s = boba::contact_force(p.k, p.k3, p.gamma, p.diameter, r, approach * inverse_r) * inverse_r;
  double* f = force[rows.own[e]].f;
  for (int c = 0; c < 3; ++c) {
    f[c] += s * d[c];
  }
  if (with_sums) {
    const double half = 0.5 * s;
    sums.virial[0] += half * d[0] * d[0];
    sums.virial[1] += half * d[1] * d[1];
    sums.virial[2] += half * d[2] * d[2];
    sums.virial[3] += half * d[0] * d[1];
    sums.virial[4] += half * d[0] * d[2];
    sums.virial[5] += half * d[1] * d[2];
    sums.smallest_r2 = r2 < sums.smallest_r2 ? r2 : sums.smallest_r2;
    sums.potential += 0.5 * boba::contact_energy(p.k, p.k3, p.diameter, r);
    ++sums.n_touching;
  }
}

void contact_forces(const ContactRows& rows, const ContactNode* nodes, ContactForce* force, const ContactParameters& p,
                    double* scratch, std::int32_t* scratch_index, bool with_sums, ContactSums& sums) {
  const std::int64_t n_touching = touching_pairs(rows, nodes, p, scratch, scratch_index);
  for (std::int64_t t = 0; t < n_touching; ++t) {
    add_contact(rows, scratch_index[t], nodes, force, p, scratch[t], with_sums, sums);
  }
}

} // namespace
