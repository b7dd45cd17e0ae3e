// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/laws/material.h"
#include "bpm/packing/packing.h"

#include <cstdint>
#include <optional>

namespace boba {

/// I = |rate| D sqrt(rho / P): shear rate times grain diameter over the time in which pressure moves a grain; 0 without
/// shear, not-a-number without pressure.
///
/// \param rate 1/tau  \param diameter of a grain, d  \param density mass of a grain over its volume, m/d^3
/// \param pressure k/d
double inertial_number(double rate, double diameter, double density, double pressure);

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
  /// boba::inertial_number of the mean grain.
  double inertial_number(double rate, double pressure) const;
};

} // namespace boba
