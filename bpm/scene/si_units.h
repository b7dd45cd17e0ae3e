// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/scene/poisson_table.h"

namespace boba {

/// A grain as an experiment knows it, in SI units, and how many nodes stand for it.
struct SiGrain {
  double young = 0.0;    ///< E, Pa
  double poisson = 0.0;  ///< nu
  double diameter = 0.0; ///< D of a sphere, m
  double density = 0.0;  ///< rho, kg/m^3
  int nodes = 0;
};

/// What the engine's units d, m and k are in SI units for one grain, and what others follow from them.
///
///     d = D (6 n / (pi b))^(-1/3),  b = 1.226 nodes / d^3      n nodes fill the volume pi D^3 / 6
///     m = rho d^3 / b                                          they have its mass
///     k = E d / E_1(alpha)                                     E_1: the table's modulus for k = 1, nu = nu(alpha)
///
/// Source: docs/notation.md, "Units" and "Grain".
struct SiUnits {
  double length = 0.0;    ///< d, m
  double mass = 0.0;      ///< m, kg
  double stiffness = 0.0; ///< k, N/m
  double alpha = 0.0;     ///< many-body coefficient, k d
  double young = 0.0;     ///< E, k/d
  double effective = 0.0; ///< E / (2 - 2 nu^2), k/d

  double time() const;                                          ///< tau = sqrt(m / k), s
  double force() const { return stiffness * length; }           ///< k d, N
  double pressure() const { return stiffness / length; }        ///< k/d, Pa
  double energy() const { return stiffness * length * length; } ///< k d^2, J
  double velocity() const { return length / time(); }           ///< d/tau, m/s
};

/// \throws InputError when the network cannot have this Poisson's ratio; std::invalid_argument for numbers that are not
/// positive and finite.
SiUnits si_units(const SiGrain& grain, const PoissonTable& table);

/// I = rate D sqrt(rho / P), all in one system of units. \throws std::invalid_argument when P is not positive.
double inertial_number_of(const SiGrain& grain, double rate, double pressure);

} // namespace boba
