// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/material.h"
#include "bpm/packing/packing.h"

#include <cstdint>
#include <optional>

namespace boba {

/// Constants of a packing that turn sums into the numbers of docs/notation.md, "Derived numbers".
struct PackingNumbers {
  double reference_volume = 0.0; ///< d^3, sum over grains
  double grain_diameter = 0.0;   ///< d; of the sphere with the mean grain's reference volume
  double density = 0.0;          ///< m/d^3: node mass over reference volume
  std::optional<double> modulus; ///< E / (2 - 2 nu^2), k/d
  std::int64_t n_nodes = 0;

  PackingNumbers(const Packing& packing, const Material& material, std::optional<double> effective_modulus);

  /// P (2 - 2 nu^2) / E, or not-a-number when E and nu are unknown.
  double normalised(double pressure) const;
  /// Reference volume of all grains over the cell's volume; not the packing fraction of deformed grains.
  double phi_reference(const Box& box) const;
  /// rate D sqrt(rho / P); 0 without shear.
  double inertial_number(double rate, double pressure) const;
};

} // namespace boba
