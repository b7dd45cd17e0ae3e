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

} // namespace boba::measure
