// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <array>
#include <span>

namespace boba::measure {

/// A symmetric tensor as xx yy zz xy xz yz.
using Tensor6 = std::array<double, 6>;

/// What is read off a stress tensor (tension positive), k/d.
struct StressSummary {
  double pressure = 0.0; ///< -(xx + yy + zz) / 3
  double mu = 0.0; ///< xy / pressure, signed: positive in forward shear; not a number below a pressure of 1e-12 k/d
  double normal_difference_1 = 0.0; ///< N1 = xx - yy (flow minus gradient direction)
  double normal_difference_2 = 0.0; ///< N2 = yy - zz (gradient minus vorticity direction)
};

/// Source: docs/notation.md, "Stress".
StressSummary summarise_stress(const Tensor6& stress);

/// Kinetic part of the stress, -(1/V) sum m v v with the velocities relative to the streaming velocity
/// gradient (x - origin); k/d.
/// \param gradient velocity gradient of the box, 1/tau; zero unless the shear is in the velocities
/// \throws std::invalid_argument when the numbers of positions and velocities differ.
Tensor6 kinetic_stress(const Box& box, std::span<const Vector3> positions, std::span<const Vector3> velocities,
                       double node_mass = 1.0, const Matrix3& gradient = Matrix3::Zero());

/// I = rate D sqrt(rho / P): shear rate times grain diameter over the time in which pressure moves a grain.
///
/// \param rate 1/tau  \param diameter of a grain, d  \param density mass of a grain over its volume, m/d^3
/// \param pressure k/d, positive
/// \throws std::invalid_argument for a pressure, density or diameter that is not positive.
double inertial_number(double rate, double diameter, double density, double pressure);

/// P~ = P (2 - 2 nu^2) / E: pressure over the effective (Hertz) modulus.
/// \throws std::invalid_argument for E <= 0 or nu outside [-1, 0.5].
double normalised_pressure(double pressure, double young_modulus, double poisson_ratio);

} // namespace boba::measure
