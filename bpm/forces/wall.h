// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/laws/plain_laws.h"
#include "bpm/packing/box.h"
#include "bpm/packing/lane_state.h"

#include <functional>

namespace boba {

/// A rigid plane that pushes nodes towards its normal.
/// Source: docs/notation.md, "Wall".
struct Wall {
  Vector3 point = Vector3::Zero();
  Vector3 normal = Vector3::UnitZ(); ///< unit, into the material
  Vector3 velocity = Vector3::Zero();
  double force = 0.0; ///< of the material on the wall, against the normal, k d; set by every evaluation
};

/// Adds a force to a node of the grain at hand.
using LaneForce = std::function<void(int node, const Vector3& force)>;

/// By the contact law that the packing has: a wall is a mirror image. Hands one wall's forces on one grain to `f` and
/// returns their sum along the normal. The virial (position of the contact plane times force) goes to the sums when
/// asked for.
double add_wall_forces(const Wall& wall, const PlainContact& contact, const LaneLayout& layout, int grain,
                       const LaneState& state, const LaneForce& f, bool with_sums, kernels::ContactSums& sums);

} // namespace boba
