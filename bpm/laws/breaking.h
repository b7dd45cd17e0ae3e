// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/bond.h"
#include "bpm/laws/law_function.h"

#include <cstdint>

namespace boba {

/// What breaks the bonds of some grains; none by default.
struct Breaking {
  double strain = 0.0;          ///< e_c, above which a bond breaks; 0: bonds never break
  bool in_tension_only = false; ///< a bond that is compressed does not break
  bool smooth = false;          ///< the force fades as the strain nears e_c
  double weibull_modulus = 0.0; ///< of the scatter of e_c from bond to bond, `strain` its scale; 0: no scatter
  std::uint64_t seed = 1;       ///< of the scatter

  bool is_possible() const { return strain > 0.0; }
  bool operator==(const Breaking&) const = default;
};

/// A bond that breaks for good where its strain e = (r - r0) / r0 exceeds e_c, in either sense or in tension alone.
///
///     f = w f_bond,   w = 1, or with smoothing 1 - (e / e_c)^8,   f = 0 once |e| > e_c
///
/// f_bond is the force of BondLaw: spring, many-body term and damper. In tension alone a compressed bond has e = 0 in
/// these lines. A bond that breaks exerts no force from that evaluation on; V and V0 of its nodes lose it from the
/// next.
///
/// A bond remembers one number, e_c^2, which is negative once it is broken. Laws with such a memory have `n_remembered`
/// numbers, of which this is the first; their functions take them by reference and bring them up to date.
/// Source: LAMMPS, bond style bpm/spring (keywords break, smooth); docs/notation.md, "Breaking".
template <class Scalar> struct BreakingBondLawOf {
  static constexpr int n_remembered = 1;

  BondLawOf<Scalar> bond;
  bool in_tension_only = false, smooth = false;

  template <class Other> BOBA_LAW_FUNCTION BreakingBondLawOf<Other> in() const {
    return {bond.template in<Other>(), in_tension_only, smooth};
  }

  /// The force of a bond with this memory, which is brought up to date; other arguments as in BondLaw. 8 to 14
  /// operations more than there.
  template <class Real>
  BOBA_LAW_FUNCTION Real force(Real alpha, Real r, Scalar r0, Scalar inverse_r0, Real cbrt_ratio, Real normal_velocity,
                               Real (&memory)[n_remembered]) const {
    return held(bond.force(alpha, r, r0, inverse_r0, cbrt_ratio, normal_velocity), r, inverse_r0, memory[0]);
  }
  template <class Real>
  BOBA_LAW_FUNCTION Real pairwise_force(Real r, Scalar r0, Scalar inverse_r0, Real normal_velocity,
                                        Real (&memory)[n_remembered]) const {
    return held(bond.pairwise_force(r, r0, inverse_r0, normal_velocity), r, inverse_r0, memory[0]);
  }

  /// The elastic energy of a bond at rest, k r0^2 (e^2 / 2 - e^10 / (10 e_c^8)) with smoothing; 0 when broken.
  template <class Real> BOBA_LAW_FUNCTION Real energy(Real r, Scalar r0, const Real (&memory)[n_remembered]) const {
    const Real limit2 = memory[0];
    const Real square = counted_square(r, Scalar(1) / r0), ratio = square / limit2;
    const Real faded = Scalar(0.1) * bond.k * r0 * r0 * square * ratio * ratio * ratio * ratio;
    const Real whole = bond.energy(r, r0);
    return limit2 > Real() ? (smooth ? whole - faded : whole) : Real();
  }

  /// x of a whole bond, 0 of a broken one.
  template <class Real> BOBA_LAW_FUNCTION static Real if_whole(Real x, const Real (&memory)[n_remembered]) {
    return memory[0] > Real() ? x : Real();
  }
  /// The length whose cube V0 counts.
  template <class Real, class Number>
  BOBA_LAW_FUNCTION static Real rest_length(Number r0, const Real (&)[n_remembered]) {
    return Real() + r0;
  }

  /// The force of a bond that has remembered `limit2`, which is brought up to date, from what it would be without
  /// breaking.
  template <class Real> BOBA_LAW_FUNCTION Real held(Real f, Real r, Scalar inverse_r0, Real& limit2) const {
    const Real square = counted_square(r, inverse_r0);
    limit2 = square <= limit2 ? limit2 : Real() - Scalar(1);
    if (smooth) {
      const Real ratio = square / limit2, fourth = ratio * ratio;
      f = f - f * (fourth * fourth);
    }
    return limit2 > Real() ? f : Real();
  }

private:
  /// e^2 of the strain that counts.
  template <class Real> BOBA_LAW_FUNCTION Real counted_square(Real r, Scalar inverse_r0) const {
    const Real strain = r * inverse_r0 - Scalar(1);
    const Real counted = in_tension_only ? (strain > Real() ? strain : Real()) : strain;
    return counted * counted;
  }
};
using BreakingBondLaw = BreakingBondLawOf<double>;

} // namespace boba
