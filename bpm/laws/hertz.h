// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/contact.h"

#include <cmath>

namespace boba {

/// Repulsion of two elastic spheres of diameter d by Hertz's law: grains of one node, in the rigid limit.
///
///     f = (2/3) E_eff sqrt(d) (d - r)^(3/2) - gamma sqrt(2 K) (e . v),   K = E_eff sqrt(d (d - r))
///
/// This is 4/3 E* sqrt(R*) overlap^(3/2) with E* = E_eff and R* = d/4; K is its slope. The damping is gamma times the
/// critical one of two nodes of unit mass on a spring K, gamma in units of sqrt(k m), and vanishes with the overlap.
/// Functions as in ContactLaw.
/// Source: Hertz (1882); the damping as a share of the critical one: Peyneau & Roux, Phys. Rev. E 78, 011307 (2008).
struct HertzLaw {
  static constexpr const char* name = "hertz";
  static constexpr Parameter modulus_parameter = {"hertz_modulus",
                                                  "k/d",
                                                  0.0,
                                                  1e6,
                                                  true,
                                                  -1.0,
                                                  "contacts of rigid spheres by Hertz's law with this E / (2 - 2 "
                                                  "nu^2), instead of k and k3; gamma is then the share of "
                                                  "critical damping. For grains of one node only"};

  double modulus;                                ///< E_eff = E / (2 - 2 nu^2), k/d
  double gamma = BondLaw::gamma_parameter.usual; ///< share of critical damping
  double diameter = 1.0;                         ///< distance at which spheres touch, d

  BOBA_LAW_FUNCTION double range() const { return diameter; }

  /// E_eff of the grains themselves: they are what touches.
  BOBA_LAW_FUNCTION double effective_modulus() const { return modulus; }

  /// The force. 9 operations and two square roots.
  template <class Real> BOBA_LAW_FUNCTION Real force(Real r, Real normal_velocity) const {
    const Real overlap = overlap_at(r), stiffness = stiffness_at(overlap);
    return 2.0 / 3.0 * stiffness * overlap - gamma * square_root(2.0 * stiffness) * normal_velocity;
  }

  /// Derivatives of the force: -K + gamma sqrt(2 K) (e . v) / (4 (d - r)) and -gamma sqrt(2 K); for r < d.
  template <class Real> BOBA_LAW_FUNCTION ContactSlopes<Real> slopes(Real r, Real normal_velocity) const {
    const Real overlap = overlap_at(r), stiffness = stiffness_at(overlap);
    const Real damping = gamma * square_root(2.0 * stiffness);
    return {damping * normal_velocity / (4.0 * overlap) - stiffness, -damping};
  }

  /// Elastic energy, (4/15) E_eff sqrt(d) (d - r)^(5/2) (k d^2).
  template <class Real> BOBA_LAW_FUNCTION Real energy(Real r) const {
    const Real overlap = overlap_at(r);
    return 4.0 / 15.0 * stiffness_at(overlap) * overlap * overlap;
  }

private:
  /// Rounding may put a distance that was found to be below d just beyond.
  template <class Real> BOBA_LAW_FUNCTION Real overlap_at(Real r) const {
    const Real overlap = diameter - r;
    return overlap > Real() ? overlap : Real();
  }
  template <class Real> BOBA_LAW_FUNCTION Real stiffness_at(Real overlap) const {
    return modulus * square_root(diameter * overlap);
  }
  /// Of a number, or lane by lane.
  template <class Real> [[gnu::always_inline]] static Real square_root(Real x) {
    if constexpr (requires { std::sqrt(x); }) {
      return std::sqrt(x);
    } else {
      Real root = x;
      for (unsigned lane = 0; lane < sizeof(Real) / sizeof(double); ++lane) {
        root[lane] = std::sqrt(x[lane]);
      }
      return root;
    }
  }
};

} // namespace boba
