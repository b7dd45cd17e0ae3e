// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <cmath>

namespace boba {

/// Can a cell from a file be computed with? Its lengths are positive, and volume and inverse neither overflow nor
/// vanish.
inline bool is_usable_cell(const Vector3& lengths, const Vector3& tilts_xy_xz_yz) {
  if (!lengths.allFinite() || !tilts_xy_xz_yz.allFinite() || !(lengths.array() > 0.0).all()) {
    return false;
  }
  const Vector3 lengths_along_tilts(lengths[0], lengths[0], lengths[1]);
  if ((tilts_xy_xz_yz.cwiseAbs().array() > 1000.0 * lengths_along_tilts.array()).any()) {
    return false;
  }
  const Box box(Vector3::Zero(), lengths, tilts_xy_xz_yz);
  return box.h_inverse().allFinite() && box.volume() > 0.0 && std::isfinite(box.volume());
}

} // namespace boba
