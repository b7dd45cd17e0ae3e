// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/breaking.h"

#include <cmath>

namespace boba {

/// When the bonds of some grains yield; never by default.
struct Yielding {
  double strain = 0.0;    ///< e_p, the elastic strain at which a bond yields; 0: bonds never yield
  double hardening = 0.0; ///< H: by how much that strain grows with the plastic strain that a bond has undergone

  bool is_possible() const { return strain > 0.0; }
  bool operator==(const Yielding&) const = default;
};

/// A bond that yields, elastic and perfectly plastic or with linear hardening; it may break too, as BreakingBondLaw
/// does.
///
///     f = k (r_eq - r) + alpha (q^(1/3) - r / r_eq) - gamma (e . v),   q = (V_i + V_j) / (V0_i + V0_j)
///     |r - r_eq| / r_eq <= e_p + H p
///
/// The length without force r_eq is r0 at first and follows the bond so that the second line holds; p is the sum of all
/// |d r_eq| / r_eq. V0_i is the sum of r_eq^3 over the bonds of node i: the many-body term too compares with the
/// lengths without force, so that a grain whose bonds are all at their r_eq has no force left in it, whatever its
/// shape. What breaks a bond is (r - r0) / r0. V0 follows r_eq from the next evaluation on.
///
/// A bond remembers e_c^2 (negative: broken), r_eq (d) and p.
/// Source: LAMMPS, bond style bpm/spring/plastic, for H = 0; Clemmer & Lechman, Powder Technology (2025).
template <class Scalar> struct YieldingBondLawOf {
  static constexpr int n_remembered = 3;

  BreakingBondLawOf<Scalar> breaking;
  Scalar yield_strain, hardening = Scalar(0);

  template <class Other> BOBA_LAW_FUNCTION YieldingBondLawOf<Other> in() const {
    return {breaking.template in<Other>(), static_cast<Other>(yield_strain), static_cast<Other>(hardening)};
  }

  template <class Real>
  BOBA_LAW_FUNCTION Real force(Real alpha, Real r, Scalar /*r0*/, Scalar inverse_r0, Real cbrt_ratio,
                               Real normal_velocity, Real (&memory)[n_remembered]) const {
    const Real stretch = yield(r, memory);
    const Real f =
        breaking.bond.k * (memory[1] - r) + alpha * (cbrt_ratio - stretch) - breaking.bond.gamma * normal_velocity;
    return breaking.held(f, r, inverse_r0, memory[0]);
  }
  template <class Real>
  BOBA_LAW_FUNCTION Real pairwise_force(Real r, Scalar /*r0*/, Scalar inverse_r0, Real normal_velocity,
                                        Real (&memory)[n_remembered]) const {
    yield(r, memory);
    return breaking.held(breaking.bond.k * (memory[1] - r) - breaking.bond.gamma * normal_velocity, r, inverse_r0,
                         memory[0]);
  }

  /// The elastic energy of a bond at rest, k (r - r_eq)^2 / 2; 0 when broken.
  template <class Real> BOBA_LAW_FUNCTION Real energy(Real r, Scalar /*r0*/, const Real (&memory)[n_remembered]) const {
    return if_whole(Scalar(0.5) * breaking.bond.k * (r - memory[1]) * (r - memory[1]), memory);
  }

  template <class Real> BOBA_LAW_FUNCTION static Real if_whole(Real x, const Real (&memory)[n_remembered]) {
    return memory[0] > Real() ? x : Real();
  }
  /// The length whose cube V0 counts.
  template <class Real, class Number>
  BOBA_LAW_FUNCTION static Real rest_length(Number /*r0*/, const Real (&memory)[n_remembered]) {
    return memory[1];
  }

private:
  /// Brings r_eq and p up to date; returns r / r_eq. In the sense s of the excess, with L = e_p + H p and
  /// y = r_eq' / r_eq,
  ///     r / r_eq = y (1 + s L + s H |y - 1|),   s |y - 1| = y - 1
  /// is a quadratic equation in y: H y^2 + (1 + s L - H) y - r / r_eq = 0. It is solved only where some lane yields.
  template <class Real> BOBA_LAW_FUNCTION Real yield(Real r, Real (&memory)[n_remembered]) const {
    const Real one = Real() + Scalar(1), limit = yield_strain + hardening * memory[2];
    const Real stretch = r / memory[1], strain = stretch - one;
    const auto yields = (strain > limit) | (strain < -limit);
    if (__builtin_expect(holds_in_any(yields), 0)) {
      const Real b = one + (strain > Real() ? limit : -limit);
      Real y = stretch / b;
      if (hardening != Scalar(0)) {
        const Real c = b - hardening;
        y = Scalar(2) * stretch / (c + square_root_of(c * c + Scalar(4) * hardening * stretch));
      }
      const Real plastic = y > one ? y - one : one - y;
      memory[2] = yields ? memory[2] + plastic : memory[2];
      memory[1] = yields ? memory[1] * y : memory[1];
      return yields ? stretch / y : stretch;
    }
    return stretch;
  }
  /// Of a number, or lane by lane.
  template <class Real> [[gnu::always_inline]] static Real square_root_of(Real x) {
    if constexpr (requires { std::sqrt(x); }) {
      return std::sqrt(x);
    } else {
      Real root = x;
      for (unsigned lane = 0; lane < sizeof(Real) / sizeof(Scalar); ++lane) {
        root[lane] = std::sqrt(x[lane]);
      }
      return root;
    }
  }
};
using YieldingBondLaw = YieldingBondLawOf<double>;

} // namespace boba
