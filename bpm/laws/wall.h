// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/contact.h"

namespace boba {

/// Force of a rigid plane on a node at distance z < d/2 from it, along the normal into the material (k d).
///
/// The node feels the contact law of its own mirror image: r = 2 z, and twice its normal velocity relative to the wall.
/// \param z distance from the plane, d
/// \param normal_velocity n . (v - u), d/tau, positive when the node leaves the wall
/// Source: docs/notation.md, "Wall".
template <class Real, class Scalar>
constexpr Real wall_force(Scalar k, Scalar k3, Scalar gamma, Scalar diameter, Real z, Real normal_velocity) {
  return contact_force(k, k3, gamma, diameter, Scalar(2) * z, Scalar(2) * normal_velocity);
}

} // namespace boba
