// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

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
template <class Real, class Scalar> constexpr Real contact_energy(Scalar k, Scalar k3, Scalar diameter, Real r) {
  const Real overlap = diameter - r;
  const Real square = overlap * overlap;
  return Scalar(0.5) * k * square + Scalar(0.25) * k3 * square * square;
}

/// Stiffness dF/d(overlap) of Hertz's contact of two spheres of diameter d, E_eff sqrt(d (d - r)) (k).
/// Units: effective modulus E_eff = E / (2 - 2 nu^2) in k/d, lengths d. Valid for r < d only.
template <class Real, class Scalar> Real hertz_stiffness(Scalar effective_modulus, Scalar diameter, Real r) {
  using std::sqrt;
  return effective_modulus * sqrt(diameter * (diameter - r));
}

/// Magnitude of the force between two rigid-limit spheres, positive when it pushes them apart (k d).
///
///     f = (2/3) E_eff sqrt(d) (d - r)^(3/2) - gamma sqrt(2 K) (e . v),   K = dF/d(overlap)
///
/// This is 4/3 E* sqrt(R*) overlap^(3/2) with E* = E_eff and R* = d/4. The damping is gamma times the critical one of
/// two nodes of unit mass on a spring K, gamma in units of sqrt(k m), and vanishes with the overlap.
/// Valid for r < d only; the caller tests that.
/// Source: Hertz (1882); the damping as a share of the critical one: Peyneau & Roux, Phys. Rev. E 78, 011307 (2008).
template <class Real, class Scalar>
Real hertz_force(Scalar effective_modulus, Scalar gamma, Scalar diameter, Real r, Real normal_velocity) {
  using std::sqrt;
  const Real stiffness = hertz_stiffness(effective_modulus, diameter, r);
  return Scalar(2) / Scalar(3) * stiffness * (diameter - r) - gamma * sqrt(Scalar(2) * stiffness) * normal_velocity;
}

/// Elastic energy of that contact, (4/15) E_eff sqrt(d) (d - r)^(5/2) (k d^2).
template <class Real, class Scalar> Real hertz_energy(Scalar effective_modulus, Scalar diameter, Real r) {
  const Real overlap = diameter - r;
  return Scalar(4) / Scalar(15) * hertz_stiffness(effective_modulus, diameter, r) * overlap * overlap;
}

} // namespace boba
