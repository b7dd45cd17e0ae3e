// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/laws/material.h"
#include "bpm/packing/box.h"
#include "bpm/packing/lane_layout.h"

namespace boba {

/// A rigid plane that pushes nodes towards its normal.
/// Source: docs/notation.md, "Wall".
struct Wall {
  Vector3 point = Vector3::Zero();
  Vector3 normal = Vector3::UnitZ(); ///< unit, into the material
  Vector3 velocity = Vector3::Zero();
  double force = 0.0; ///< of the material on the wall, against the normal, k d; set by every evaluation
};

/// Adds one wall's forces on one grain to `f` (indexed like the arrays of the state) and returns their sum along the normal. The virial (position of the
/// contact plane times force) goes to the sums when asked for.
double add_wall_forces(const Wall& wall, const Material& material, const LaneLayout& layout, int grain,
                       const LaneState& state, double* f, bool with_sums, kernels::ContactSums& sums);

} // namespace boba
