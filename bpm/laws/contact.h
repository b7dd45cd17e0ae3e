// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/bond.h"
#include "bpm/laws/law_function.h"
#include "bpm/laws/parameter.h"

namespace boba {

/// Derivatives of a contact's force with respect to what it depends on.
template <class Real> struct ContactSlopes {
  Real by_distance;        ///< df/dr, k
  Real by_normal_velocity; ///< df/d(e . v), sqrt(k m)
};

/// Repulsion of two unbonded nodes closer than d: Hooke's spring, a cubic term and a damper.
///
///     f = k (d - r) + k3 (d - r)^3 - gamma s (e . v),   s = 1 - (r/d)^8
///
/// The force (k d) acts along e = (x_i - x_j) / r and is positive when it pushes the two nodes apart. The factor s lets
/// the damping start from zero, so that the force is continuous at r = d.
///
/// Every contact law has these functions. `r` is the distance (d), `normal_velocity` = e . v (d/tau), positive when the
/// nodes part. They are evaluated for r up to `range()`, where force and energy are zero; a wall also asks for r < 0, a
/// node behind the plane. `Real` is double, long double or a vector of doubles.
/// Source: Clemmer, Hackney & Grest (Hookean, damping, cubic repulsion 50 k/d^2); s from the authors' published code.
struct ContactLaw {
  static constexpr const char* name = "hookean";
  static constexpr Parameter k3_parameter = {
      "k3", "k/d^2", 0.0, 1e6, false, 50.0, "cubic part of the contact repulsion"};

  double k = BondLaw::k_parameter.usual;         ///< stiffness at touch, k
  double gamma = BondLaw::gamma_parameter.usual; ///< damping, sqrt(k m)
  double k3 = k3_parameter.usual;                ///< cubic repulsion, k/d^2
  double diameter = 1.0;                         ///< distance at which nodes touch, d

  /// Nodes further apart than this do not feel each other, d.
  BOBA_LAW_FUNCTION double range() const { return diameter; }

  /// The force. 14 operations.
  template <class Real> BOBA_LAW_FUNCTION Real force(Real r, Real normal_velocity) const {
    const Real overlap = diameter - r;
    return k * overlap + k3 * overlap * overlap * overlap - gamma * damping_share(r) * normal_velocity;
  }

  /// Derivatives of the force: -k - 3 k3 (d - r)^2 + 8 gamma (r/d)^7 (e . v) / d and -gamma s.
  template <class Real> BOBA_LAW_FUNCTION ContactSlopes<Real> slopes(Real r, Real normal_velocity) const {
    const Real overlap = diameter - r, x = r / diameter, x2 = x * x;
    return {-k - 3.0 * k3 * overlap * overlap + 8.0 * gamma * x2 * x2 * x2 * x / diameter * normal_velocity,
            -gamma * damping_share(r)};
  }

  /// Elastic energy, k (d-r)^2 / 2 + k3 (d-r)^4 / 4 (k d^2).
  template <class Real> BOBA_LAW_FUNCTION Real energy(Real r) const {
    const Real overlap = diameter - r;
    const Real square = overlap * overlap;
    return 0.5 * k * square + 0.25 * k3 * square * square;
  }

private:
  template <class Real> BOBA_LAW_FUNCTION Real damping_share(Real r) const {
    const Real x = r / diameter;
    const Real x2 = x * x;
    const Real x4 = x2 * x2;
    return 1.0 - x4 * x4;
  }
};

} // namespace boba
