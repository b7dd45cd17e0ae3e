// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/grain_frame.h"
#include "bpm/packing/box.h"

namespace boba {

/// Axis-aligned box, for instance around a grain's nodes, d. Empty as it comes.
struct Bounds {
  Vector3 low = Vector3::Constant(1e300);
  Vector3 high = Vector3::Constant(-1e300);

  void include(const Vector3& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  /// False also when x is no number.
  bool contains(const Vector3& x) const { return (x - low).minCoeff() >= 0.0 && (high - x).minCoeff() >= 0.0; }
  Bounds widened(double by) const { return {low - Vector3::Constant(by), high + Vector3::Constant(by)}; }
  template <class Visit> void for_each_corner(Visit&& visit) const {
    for (int corner = 0; corner < 8; ++corner) {
      Vector3 x;
      for (int axis = 0; axis < 3; ++axis) {
        x[axis] = (corner >> axis & 1) != 0 ? high[axis] : low[axis];
      }
      visit(x);
    }
  }
  /// Of this box after an affine map.
  Bounds mapped(const GrainFrame& map) const {
    Bounds result;
    for_each_corner([&](const Vector3& x) { result.include(map(x)); });
    return result;
  }
};

} // namespace boba
