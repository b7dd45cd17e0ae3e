// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"

namespace {

using boba::kernels::Drift;
using boba::kernels::DriftResult;

template <class V, bool mapped>
void drift_lanes(double* x, const double* v, int n_nodes, int stride, const Drift& drift, V& speed2, V& checksum) {
  const auto& m = drift.map;
  for (std::int64_t node = 0; node < n_nodes; ++node) {
    double* at = x + 3 * node * stride;
    const double* va = v + 3 * node * stride;
    V p[3], u[3];
    for (int c = 0; c < 3; ++c) {
      p[c] = load<V>(at + c * stride);
      u[c] = load<V>(va + c * stride);
    }
    for (int c = 0; c < 3; ++c) {
      const V moved = mapped ? m[c][0] * p[0] + m[c][1] * p[1] + m[c][2] * p[2] + drift.shift[c] : p[c];
      store<V>(at + c * stride, moved + drift.dt * u[c]);
    }
    checksum += u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    u[0] -= drift.residual[0] * p[0] + drift.residual[1] * p[1] + drift.residual[2] * p[2] + drift.residual_shift;
    speed2 = larger(speed2, u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  }
}

template <class V> DriftResult drift_as(double* x, const double* v, int n_nodes, int stride, const Drift& drift) {
  V speed2 = splat<V>(0.0), checksum = splat<V>(0.0);
  for (int lane = 0; lane < stride; lane += lanes_of<V>) {
    if (drift.mapped) {
      drift_lanes<V, true>(x + lane, v + lane, n_nodes, stride, drift, speed2, checksum);
    } else {
      drift_lanes<V, false>(x + lane, v + lane, n_nodes, stride, drift, speed2, checksum);
    }
  }
  return {largest_of(speed2), sum_of(checksum)};
}

DriftResult drift_block(double* x, const double* v, int n_nodes, int n_lanes, const Drift& drift) {
  return n_lanes == 1 ? drift_as<double>(x, v, n_nodes, 1, drift) : drift_as<Wide>(x, v, n_nodes, n_lanes, drift);
}

} // namespace
