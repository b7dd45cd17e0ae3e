// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/contact/interface_law.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::continuum {

double InterfaceLaw::overlap(double pressure) const {
  if (rigid()) {
    return 0;
  }
  if (c3 == 0) {
    return pressure / c1;
  }
  // The cubic is increasing: one real root, by the hyperbolic form of Cardano's formula, which loses no digits.
  const double scale = 2 * std::sqrt(c1 / (3 * c3));
  const double s = 4 * pressure / (c3 * scale * scale * scale);
  return scale * std::sinh(std::asinh(s) / 3);
}

double InterfaceLaw::softness(double pressure) const {
  if (rigid()) {
    return 0;
  }
  const double g = overlap(pressure);
  return 1 / (c1 + 3 * c3 * g * g);
}

void check(const InterfaceLaw& law) {
  if (!(law.c1 > 0)) {
    throw std::invalid_argument(fmt::format("c1 = {} is not allowed: it must be > 0 (stress per length)", law.c1));
  }
  if (!(law.c3 >= 0) || !std::isfinite(law.c3)) {
    throw std::invalid_argument(
        fmt::format("c3 = {} is not allowed: it must be finite and >= 0 (stress per length^3)", law.c3));
  }
}

} // namespace boba::continuum
