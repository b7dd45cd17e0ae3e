// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"

namespace {

using boba::kernels::FrameArrays;
using boba::kernels::FrameFit;
using boba::kernels::LaneFrames;

inline double widened(const float* from, double) { return *from; }
inline Wide widened(const float* from, Wide) {
  WideFloat value;
  std::memcpy(&value, from, sizeof value);
  return __builtin_convertvector(value, Wide);
}

template <class V> void fit_lanes(const FrameArrays& a, int lane, FrameFit& fit) {
  V origin[3], first[3] = {}, second[9] = {};
  for (int c = 0; c < 3; ++c) {
    origin[c] = load<V>(&fit.origin[c][lane]);
  }
  for (std::int64_t node = 0; node < a.n_nodes; ++node) {
    const std::int64_t at = 3 * node * a.n_lanes + lane;
    V reference[3];
    for (int c = 0; c < 3; ++c) {
      reference[c] = widened(a.reference + at + c * a.n_lanes, V{});
    }
    for (int row = 0; row < 3; ++row) {
      const V x = load<V>(a.x + at + row * a.n_lanes) - origin[row];
      first[row] += x;
      for (int column = 0; column < 3; ++column) {
        second[3 * row + column] = multiply_add(x, reference[column], second[3 * row + column]);
      }
    }
  }
  for (int c = 0; c < 3; ++c) {
    store<V>(&fit.first[c][lane], first[c]);
  }
  for (int c = 0; c < 9; ++c) {
    store<V>(&fit.second[c][lane], second[c]);
  }
}

void fit_frames(const FrameArrays& arrays, FrameFit& fit) {
  if (arrays.n_lanes == 1) {
    fit_lanes<double>(arrays, 0, fit);
    return;
  }
  for (int lane = 0; lane < arrays.n_lanes; lane += native_lanes) {
    fit_lanes<Wide>(arrays, lane, fit);
  }
}

inline double at_most(double r2, double limit) { return r2 <= limit ? r2 : 0.0; }
inline Wide at_most(Wide r2, Wide limit) { return r2 <= limit ? r2 : Wide{}; }
inline bool any_above(double r2, double limit) { return !(r2 <= limit); }
inline bool any_above(Wide r2, Wide limit) {
  const auto above = ~(r2 <= limit);
  bool any = false;
  for (int l = 0; l < native_lanes; ++l) {
    any |= above[l] != 0;
  }
  return any;
}
inline double lane_of(double v, int) { return v; }
inline double lane_of(Wide v, int l) { return v[l]; }

template <class V>
std::int64_t residual_lanes(const FrameArrays& a, const LaneFrames& frames, int lane, double* largest2,
                            std::int32_t* far) {
  V f[9], centre[3];
  for (int c = 0; c < 9; ++c) {
    f[c] = load<V>(&frames.f[c][lane]);
  }
  for (int c = 0; c < 3; ++c) {
    centre[c] = load<V>(&frames.centre[c][lane]);
  }
  const V limit = load<V>(frames.threshold2 + lane);
  V largest{};
  std::int64_t n_far = 0;
  for (std::int64_t node = 0; node < a.n_nodes; ++node) {
    const std::int64_t at = 3 * node * a.n_lanes + lane;
    V reference[3], r2{};
    for (int c = 0; c < 3; ++c) {
      reference[c] = widened(a.reference + at + c * a.n_lanes, V{});
    }
    for (int row = 0; row < 3; ++row) {
      V d = load<V>(a.x + at + row * a.n_lanes) - centre[row];
      for (int column = 0; column < 3; ++column) {
        d = subtract_product(d, f[3 * row + column], reference[column]);
      }
      r2 = multiply_add(d, d, r2);
    }
    largest = larger(largest, at_most(r2, limit));
    if (__builtin_expect(any_above(r2, limit), 0)) {
      for (int l = 0; l < lanes_of<V>; ++l) {
        if (!(lane_of(r2, l) <= lane_of(limit, l))) {
          far[n_far++] = static_cast<std::int32_t>(node * a.n_lanes + lane + l);
        }
      }
    }
  }
  store<V>(largest2 + lane, largest);
  return n_far;
}

std::int64_t frame_residuals(const FrameArrays& arrays, const LaneFrames& frames, double* largest2, std::int32_t* far) {
  if (arrays.n_lanes == 1) {
    return residual_lanes<double>(arrays, frames, 0, largest2, far);
  }
  std::int64_t n_far = 0;
  for (int lane = 0; lane < arrays.n_lanes; lane += native_lanes) {
    n_far += residual_lanes<Wide>(arrays, frames, lane, largest2, far + n_far);
  }
  return n_far;
}

} // namespace
