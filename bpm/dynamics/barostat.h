// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

namespace boba {

/// The linear barostat: d ln L / dt = gain (P - target), limited to +- `rate_cap`.
struct Barostat {
  double pressure = 0.0;      ///< target, k/d
  std::optional<double> gain; ///< d/(k tau); absent: from the measured bulk modulus, see docs/notation.md
  double rate_cap = 1e-3;     ///< largest |d ln L / dt|, 1/tau
};

/// What the default gain is made from.
struct BarostatContext {
  double bulk_modulus = 0.0;   ///< of the packing, k/d
  double sound_crossing = 0.0; ///< time of sound across the shortest side of the cell, tau
  double shear_rate = 0.0;     ///< 1/tau, 0 when nothing shears
};

/// The barostat's own gain or, by default, g = 1 / (3 K t_c) with t_c = min(0.01 / |rate|, 100 tau), but t_c at least
/// three sound crossings of the cell: d/(k tau). Source: docs/notation.md, "Barostat".
double barostat_gain(const Barostat& barostat, const BarostatContext& context);

/// d ln L / dt = gain (P - target), limited to +- rate_cap (1/tau).
double barostat_rate(const Barostat& barostat, double gain, double pressure);

} // namespace boba
