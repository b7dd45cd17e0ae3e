// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bpm/laws/contact.h>

/// A contact that stiffens with its overlap: f = k (d - r) + s (d - r)^2 - gamma (1 - r / d) (e . v).
struct StiffeningContact {
  double k = 1.0;          ///< stiffness at touch, k
  double stiffening = 0.0; ///< s, k/d
  double gamma = 0.0;      ///< damping, sqrt(k m)
  double diameter = 1.0;   ///< distance at which nodes touch, d

  BOBA_LAW_FUNCTION double range() const { return diameter; }
  template <class Real> BOBA_LAW_FUNCTION Real force(Real r, Real normal_velocity) const {
    const Real overlap = diameter - r;
    return k * overlap + stiffening * overlap * overlap - gamma / diameter * overlap * normal_velocity;
  }
  template <class Real> BOBA_LAW_FUNCTION boba::ContactSlopes<Real> slopes(Real r, Real normal_velocity) const {
    const Real overlap = diameter - r;
    return {gamma / diameter * normal_velocity - k - 2.0 * stiffening * overlap, -gamma / diameter * overlap};
  }
  template <class Real> BOBA_LAW_FUNCTION Real energy(Real r) const {
    const Real overlap = diameter - r;
    return 0.5 * k * overlap * overlap + stiffening / 3.0 * overlap * overlap * overlap;
  }
};
