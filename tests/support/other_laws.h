// SPDX-License-Identifier: GPL-3.0-or-later
// Laws that differ from those of the tree, in the form that bpm/laws gives them.
#pragma once

#include "bpm/laws/contact.h"

namespace boba::test {

/// A bond with twice the stiffness, a cubic term and a many-body term that is not linear in the volumes:
///
///     f = 2 k (r0 - r) + c (r0 - r)^3 + alpha (q^(2/3) - r / r0) - gamma (e . v)
template <class Scalar> struct StiffeningBondOf {
  Scalar k = 1, gamma = Scalar(0.5), cubic = 7;

  template <class Other> BOBA_LAW_FUNCTION StiffeningBondOf<Other> in() const {
    return {static_cast<Other>(k), static_cast<Other>(gamma), static_cast<Other>(cubic)};
  }
  BOBA_LAW_FUNCTION bool is_damped() const { return gamma != Scalar(0); }

  template <class Real>
  BOBA_LAW_FUNCTION Real force(Real alpha, Real r, Scalar r0, Scalar inverse_r0, Real cbrt_ratio,
                               Real normal_velocity) const {
    return alpha * (cbrt_ratio * cbrt_ratio - r * inverse_r0) + pairwise_force(r, r0, inverse_r0, normal_velocity);
  }
  template <class Real>
  BOBA_LAW_FUNCTION Real pairwise_force(Real r, Scalar r0, Scalar /*inverse_r0*/, Real normal_velocity) const {
    const Real shortening = r0 - r;
    return Scalar(2) * k * shortening + cubic * shortening * shortening * shortening - gamma * normal_velocity;
  }
  template <class Real>
  BOBA_LAW_FUNCTION BondSlopes<Real> slopes(Real alpha, Real r, Scalar r0, Scalar inverse_r0, Real cbrt_ratio,
                                            Real /*normal_velocity*/) const {
    return {-Scalar(2) * k - Scalar(3) * cubic * (r0 - r) * (r0 - r) - alpha * inverse_r0,
            Scalar(2) * alpha * cbrt_ratio, Real() - gamma};
  }
};
using StiffeningBond = StiffeningBondOf<double>;

/// The contact of the tree with a term of its own: f = k (d - r) + extra (d - r)^2, undamped.
struct ParabolicContact {
  double k = 1.0, extra = 3.0, diameter = 1.0;

  BOBA_LAW_FUNCTION double range() const { return diameter; }
  template <class Real> BOBA_LAW_FUNCTION Real force(Real r, Real /*normal_velocity*/) const {
    return k * (diameter - r) + extra * (diameter - r) * (diameter - r);
  }
  template <class Real> BOBA_LAW_FUNCTION ContactSlopes<Real> slopes(Real r, Real /*normal_velocity*/) const {
    return {-k - 2.0 * extra * (diameter - r), Real()};
  }
  template <class Real> BOBA_LAW_FUNCTION Real energy(Real r) const {
    const Real overlap = diameter - r;
    return 0.5 * k * overlap * overlap + extra / 3.0 * overlap * overlap * overlap;
  }
};

} // namespace boba::test
