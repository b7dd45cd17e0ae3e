// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/law_function.h"
#include "bpm/laws/parameter.h"

namespace boba {

/// Derivatives of a bond's force with respect to what it depends on; the others stay as they are.
template <class Real> struct BondSlopes {
  Real by_distance;        ///< df/dr, k
  Real by_cbrt_ratio;      ///< df/d(q^(1/3)), k d
  Real by_normal_velocity; ///< df/d(e . v), sqrt(k m)
};

/// The bond: a spring, the many-body term and a damper.
///
///     f = k (r0 - r) + alpha (q^(1/3) - r / r0) - gamma (e . v),   q = (V_i + V_j) / (V0_i + V0_j)
///
/// The force (k d) acts along e = (x_i - x_j) / r and is positive when it pushes the two nodes apart. V_i is the sum of
/// r^3 over the bonds of node i, V0_i the same sum undeformed; whoever evaluates the law sums them up.
///
/// Arguments of all functions:
/// * `alpha`: the many-body coefficient of the grain, k d;
/// * `r`: distance, d; `r0`: the distance without force, d; `inverse_r0` = 1 / r0, which a template stores;
/// * `cbrt_ratio` = q^(1/3), 1 without deformation;
/// * `normal_velocity` = e . v = (x_i - x_j) . (v_i - v_j) / r, d/tau, positive when the nodes part.
///
/// `Scalar` is the type of the constants (float or double). `Real` is that of the rest: float, double, long double or a
/// vector of lanes. The hot loop, its oracle, the stable time step and the static solver evaluate these very lines.
/// Source: Clemmer, Hackney & Grest, "Shear and crystallization in deformable granular packings", bond force.
template <class Scalar> struct BondLawOf {
  static constexpr Parameter k_parameter = {
      "k", "k", 0.0, 1e6, true, 1.0, "stiffness of bonds and contacts (1 in the engine's units)"};
  static constexpr Parameter gamma_parameter = {
      "gamma", "sqrt(k m)", 0.0, 100.0, false, 1.0, "damping of bonds and contacts"};

  Scalar k = static_cast<Scalar>(k_parameter.usual);         ///< stiffness, k
  Scalar gamma = static_cast<Scalar>(gamma_parameter.usual); ///< damping, sqrt(k m)

  /// The same law with constants of another type.
  template <class Other> BOBA_LAW_FUNCTION BondLawOf<Other> in() const {
    return {static_cast<Other>(k), static_cast<Other>(gamma)};
  }
  /// False: the force does not depend on velocities, and the loops do not read them.
  BOBA_LAW_FUNCTION bool is_damped() const { return gamma != Scalar(0); }

  /// The force. 9 operations, and those of the cube root.
  template <class Real>
  BOBA_LAW_FUNCTION Real force(Real alpha, Real r, Scalar r0, Scalar inverse_r0, Real cbrt_ratio,
                               Real normal_velocity) const {
    return k * (r0 - r) + alpha * (cbrt_ratio - r * inverse_r0) - gamma * normal_velocity;
  }

  /// The same at alpha = 0: a damped spring, which needs no volumes. 4 operations.
  template <class Real>
  BOBA_LAW_FUNCTION Real pairwise_force(Real r, Scalar r0, Scalar /*inverse_r0*/, Real normal_velocity) const {
    return k * (r0 - r) - gamma * normal_velocity;
  }

  /// Derivatives of the force: -k - alpha / r0, alpha, -gamma.
  template <class Real>
  BOBA_LAW_FUNCTION BondSlopes<Real> slopes(Real alpha, Real /*r*/, Scalar /*r0*/, Scalar inverse_r0,
                                            Real /*cbrt_ratio*/, Real /*normal_velocity*/) const {
    return {-k - alpha * inverse_r0, alpha, Real() - gamma};
  }

  /// Elastic energy of the spring, k (r - r0)^2 / 2 (k d^2). The many-body term has no energy.
  template <class Real> BOBA_LAW_FUNCTION Real energy(Real r, Scalar r0) const {
    return Scalar(0.5) * k * (r - r0) * (r - r0);
  }
};
using BondLaw = BondLawOf<double>;

} // namespace boba
