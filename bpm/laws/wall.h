// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/contact.h"

namespace boba {

// A rigid plane acts on a node at distance z from it as the node's own mirror image would, by whatever contact law
// there is: r = 2 z, and twice the normal velocity relative to the wall.
//
// z: distance from the plane, d; a node feels it below half the law's range.
// normal_velocity: n . (v - u), d/tau, positive when the node leaves the wall.
// Source: docs/notation.md, "Wall".

/// Force of the plane on the node, along the normal into the material (k d).
template <class Law> double wall_force(const Law& contact, double z, double normal_velocity) {
  return contact.force(2.0 * z, 2.0 * normal_velocity);
}

/// Derivatives of that force with respect to z and to the node's normal velocity.
template <class Law> ContactSlopes<double> wall_slopes(const Law& contact, double z, double normal_velocity) {
  const ContactSlopes<double> slopes = contact.slopes(2.0 * z, 2.0 * normal_velocity);
  return {2.0 * slopes.by_distance, 2.0 * slopes.by_normal_velocity};
}

/// The node's half of the energy of the contact with its image (k d^2); minus its derivative by z is the elastic force.
template <class Law> double wall_energy(const Law& contact, double z) {
  return 0.5 * contact.energy(2.0 * z);
}

} // namespace boba
