// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only. The law itself is in bpm/laws/contact.h.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/laws/contact.h"

#include <cmath>

namespace {

using boba::kernels::ContactParameters;
using boba::kernels::ContactRows;
using boba::kernels::ContactSums;

/// Squared distances of all candidates: gathers, but no branch, so that the compiler uses the vector unit.
inline void candidate_distances(const ContactRows& rows, const double* __restrict own_x, const double* __restrict x,
                                const double* __restrict shift, double* __restrict r2) {
  const std::int64_t so = rows.own_stride, st = rows.other_stride;
#pragma GCC ivdep
  for (std::int64_t e = 0; e < rows.n; ++e) {
    const std::int32_t i = rows.own[e], j = rows.other[e], image = 3 * rows.image[e];
    const double dx = own_x[i] - x[j] - shift[image];
    const double dy = own_x[i + so] - x[j + st] - shift[image + 1];
    const double dz = own_x[i + 2 * so] - x[j + 2 * st] - shift[image + 2];
    r2[e] = dx * dx + dy * dy + dz * dz;
  }
}

/// The force of one touching pair, added to `f` in list order (a fixed order: results do not depend on threads).
inline void add_contact(const ContactRows& rows, std::int64_t e, const double* own_x, const double* own_v, const double* x,
                        const double* v, double* f, const ContactParameters& p, double r2, bool with_sums,
                        ContactSums& sums) {
  const std::int64_t i = rows.own[e], j = rows.other[e], so = rows.own_stride, st = rows.other_stride;
  const double* shift = p.shift + 3 * rows.image[e];
  const double* shift_velocity = p.shift_velocity + 3 * rows.image[e];
  double d[3], approach = 0.0;
  for (int c = 0; c < 3; ++c) {
    d[c] = own_x[i + c * so] - x[j + c * st] - shift[c];
    approach += d[c] * (own_v[i + c * so] - v[j + c * st] - shift_velocity[c]);
  }
  const double r = std::sqrt(r2), inverse_r = 1.0 / r;
  const double s = boba::contact_force(p.k, p.k3, p.gamma, p.diameter, r, approach * inverse_r) * inverse_r;
  for (int c = 0; c < 3; ++c) {
    f[i + c * so] += s * d[c];
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

void contact_forces(const ContactRows& rows, std::int64_t own_first, const double* x, const double* v, double* f,
                    const ContactParameters& p, double* scratch, std::int32_t* scratch_index, bool with_sums,
                    ContactSums& sums) {
  const double* own_x = x + own_first;
  const double* own_v = v + own_first;
  candidate_distances(rows, own_x, x, p.shift, scratch);
  const double reach2 = p.diameter * p.diameter;
  std::int64_t n_hits = 0;
  for (std::int64_t e = 0; e < rows.n; ++e) {
    scratch_index[n_hits] = static_cast<std::int32_t>(e);
    n_hits += scratch[e] < reach2;
  }
  for (std::int64_t hit = 0; hit < n_hits; ++hit) {
    const std::int64_t e = scratch_index[hit];
    add_contact(rows, e, own_x, own_v, x, v, f, p, scratch[e], with_sums, sums);
  }
}

} // namespace
