// SPDX-License-Identifier: GPL-3.0-or-later
// Included by kernels.cpp only.
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/kernels/lanes.h"

namespace boba::kernels {
namespace {

template <class V> inline V load_floats(const float* from) {
  return converted<V>(load<Vector<float, lanes_of<V>>>(from));
}

template <class S, class Coordinate = typename S::Coordinate>
void fit_lanes(const FrameArraysOf<Coordinate>& a, int lane, FrameFit& fit) {
  using V = typename S::V;
  using P = typename S::P;
  const V q = splat<V>(a.quantum);
  V origin[3], first[3] = {}, second[9] = {};
  for (int c = 0; c < 3; ++c) {
    origin[c] = load_doubles<V>(&fit.origin[c][lane]);
  }
  for (std::int64_t node = 0; node < a.n_nodes; ++node) {
    const std::int64_t at = 3 * node * a.n_lanes + lane;
    V reference[3];
    for (int c = 0; c < 3; ++c) {
      reference[c] = load_floats<V>(a.reference + at + c * a.n_lanes);
    }
    for (int row = 0; row < 3; ++row) {
      const V x = S::value(load<P>(a.x + at + row * a.n_lanes), q) - origin[row];
      first[row] += x;
      for (int column = 0; column < 3; ++column) {
        second[3 * row + column] = multiply_add(x, reference[column], second[3 * row + column]);
      }
    }
  }
  for (int c = 0; c < 3; ++c) {
    store_doubles<V>(&fit.first[c][lane], first[c]);
  }
  for (int c = 0; c < 9; ++c) {
    store_doubles<V>(&fit.second[c][lane], second[c]);
  }
}

template <class Coordinate> void fit_frames(const FrameArraysOf<Coordinate>& arrays, FrameFit& fit) {
  for_lanes<Coordinate>(arrays.n_lanes,
                        [&](int lane, auto storage) { fit_lanes<decltype(storage)>(arrays, lane, fit); });
}

template <class V> inline auto lane_of(V v, int l) {
  if constexpr (lanes_of<V> == 1) {
    return v;
  } else {
    return v[l];
  }
}

template <class S, class Coordinate = typename S::Coordinate>
std::int64_t residual_lanes(const FrameArraysOf<Coordinate>& a, const LaneFrames& frames, int lane, double* largest2,
                            std::int32_t* far) {
  using V = typename S::V;
  using P = typename S::P;
  const V q = splat<V>(a.quantum);
  V f[9], centre[3];
  for (int c = 0; c < 9; ++c) {
    f[c] = load_doubles<V>(&frames.f[c][lane]);
  }
  for (int c = 0; c < 3; ++c) {
    centre[c] = load_doubles<V>(&frames.centre[c][lane]);
  }
  const V limit = load_doubles<V>(frames.threshold2 + lane);
  V largest{};
  std::int64_t n_far = 0;
  for (std::int64_t node = 0; node < a.n_nodes; ++node) {
    const std::int64_t at = 3 * node * a.n_lanes + lane;
    V reference[3], r2{};
    for (int c = 0; c < 3; ++c) {
      reference[c] = load_floats<V>(a.reference + at + c * a.n_lanes);
    }
    for (int row = 0; row < 3; ++row) {
      V d = S::value(load<P>(a.x + at + row * a.n_lanes), q) - centre[row];
      for (int column = 0; column < 3; ++column) {
        d = subtract_product(d, f[3 * row + column], reference[column]);
      }
      r2 = multiply_add(d, d, r2);
    }
    largest = larger(largest, r2 <= limit ? r2 : V{});
    if (__builtin_expect(any_above(r2, limit), 0)) {
      for (int l = 0; l < lanes_of<V>; ++l) {
        if (!(lane_of(r2, l) <= lane_of(limit, l))) {
          far[n_far++] = static_cast<std::int32_t>(node * a.n_lanes + lane + l);
        }
      }
    }
  }
  store_doubles<V>(largest2 + lane, largest);
  return n_far;
}

template <class Coordinate>
std::int64_t frame_residuals(const FrameArraysOf<Coordinate>& arrays, const LaneFrames& frames, double* largest2,
                             std::int32_t* far) {
  std::int64_t n_far = 0;
  for_lanes<Coordinate>(arrays.n_lanes, [&](int lane, auto storage) {
    n_far += residual_lanes<decltype(storage)>(arrays, frames, lane, largest2, far + n_far);
  });
  return n_far;
}

} // namespace
} // namespace boba::kernels
