// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba {

/// Magnitude of the bond force, positive when it pushes the two nodes apart (k d).
///
///     f = k (r0 - r) + alpha (q^(1/3) - r / r0) - gamma (e . v),   q = (V_i + V_j) / (V0_i + V0_j)
///
/// \param r distance, d
/// \param r0 distance without force, d; `inverse_r0` = 1 / r0 is handed over because a template stores it
/// \param cbrt_volume_ratio q^(1/3); 1 without deformation. Not read by the compiler's output when alpha is a known 0
/// \param normal_velocity e . v = (x_i - x_j) . (v_i - v_j) / r, d/tau, positive when the nodes part
///
/// `Real` is double, float, long double or a vector of lanes: the hot loop and the tests evaluate this very line.
/// Source: Clemmer, Hackney & Grest, "Shear and crystallization in deformable granular packings", bond force.
template <class Real, class Scalar>
constexpr Real bond_force(Scalar k, Real alpha, Scalar gamma, Real r, Scalar r0, Scalar inverse_r0,
                          Real cbrt_volume_ratio, Real normal_velocity) {
  return k * (r0 - r) + alpha * (cbrt_volume_ratio - r * inverse_r0) - gamma * normal_velocity;
}

/// The same at alpha = 0: a damped spring that needs no volumes.
template <class Real, class Scalar>
constexpr Real bond_force_pairwise(Scalar k, Scalar gamma, Real r, Scalar r0, Real normal_velocity) {
  return k * (r0 - r) - gamma * normal_velocity;
}

/// Elastic energy of the spring, k (r - r0)^2 / 2 (k d^2). The many-body term has no energy.
template <class Real, class Scalar> constexpr Real bond_energy(Scalar k, Real r, Scalar r0) {
  return Scalar(0.5) * k * (r - r0) * (r - r0);
}

} // namespace boba
