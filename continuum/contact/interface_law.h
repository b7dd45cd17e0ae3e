// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

namespace boba::continuum {

/// What lies between body and plate: nothing (rigid, Signorini) or a normal-compliance layer p = c1 g + c3 g^3 of the
/// overlap g >= 0. Units: p stress, g length. The layer of the particle model has c1 = 2 k n_s, c3 = 8 k3 n_s.
struct InterfaceLaw {
  double c1 = std::numeric_limits<double>::infinity();
  double c3 = 0;

  bool rigid() const { return c1 == std::numeric_limits<double>::infinity(); }
  /// Pressure at overlap g (odd in g; only g >= 0 is physical). Not for a rigid interface.
  double pressure(double overlap) const { return overlap * (c1 + c3 * overlap * overlap); }
  /// Overlap that carries pressure p; 0 for a rigid interface.
  double overlap(double pressure) const;
  /// d overlap / d pressure; 0 for a rigid interface.
  double softness(double pressure) const;
};

/// Throws std::invalid_argument unless c1 > 0 and c3 >= 0.
void check(const InterfaceLaw& law);

} // namespace boba::continuum
