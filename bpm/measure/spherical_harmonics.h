// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <array>
#include <complex>

namespace boba::measure {

/// Components m = -l .. l of a quantity that turns like the spherical harmonics of degree l.
template <int l> using Harmonics = std::array<std::complex<double>, 2 * l + 1>;

/// Y_lm of a direction (any length but zero), orthonormal on the sphere, with the Condon-Shortley phase; l = 4 or 6.
template <int l> Harmonics<l> spherical_harmonics(const Vector3& direction);

/// sqrt(4 pi / (2 l + 1) sum_m |q_m|^2).
template <int l> double second_invariant(const Harmonics<l>& q);

/// sum over m1 + m2 + m3 = 0 of the 3j symbol times q_m1 q_m2 q_m3, over (sum_m |q_m|^2)^(3/2); 0 for q = 0.
template <int l> double third_invariant(const Harmonics<l>& q);

/// Wigner's 3j symbol (l l l; m1 m2 -m1-m2) by Racah's sum.
double wigner_3j(int l, int m1, int m2);

} // namespace boba::measure
