// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// Magnitude of the force between two unbonded nodes closer than d, positive when it pushes them apart (k d).
///
///     f = k (d - r) + k3 (d - r)^3 - gamma s (e . v),   s = 1 - (r/d)^8
///
/// The factor s lets the damping start from zero, so that the force is continuous at r = d.
/// Valid for r < d only; the caller tests that. Units as in bond.h; k3 in k/d^2.
/// Source: Clemmer, Hackney & Grest (Hookean, damping, cubic repulsion 50 k/d^2); s from the authors' published code.
template <class Real, class Scalar>
constexpr Real contact_force(Scalar k, Scalar k3, Scalar gamma, Scalar diameter, Real r, Real normal_velocity) {
  const Real overlap = diameter - r;
  const Real x = r / diameter;
  const Real x2 = x * x;
  const Real x4 = x2 * x2;
  return k * overlap + k3 * overlap * overlap * overlap - gamma * (Scalar(1) - x4 * x4) * normal_velocity;
}

/// Elastic energy of that contact, k (d-r)^2 / 2 + k3 (d-r)^4 / 4 (k d^2).
template <class Real, class Scalar>
constexpr Real contact_energy(Scalar k, Scalar k3, Scalar diameter, Real r) {
  const Real overlap = diameter - r;
  const Real square = overlap * overlap;
  return Scalar(0.5) * k * square + Scalar(0.25) * k3 * square * square;
}

} // namespace boba
