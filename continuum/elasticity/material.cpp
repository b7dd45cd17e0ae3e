// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/material.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::continuum {

void check_positive(const char* name, double value) {
  if (!(value > 0) || !std::isfinite(value)) {
    throw std::invalid_argument(fmt::format("{} = {} is not allowed: it must be finite and > 0", name, value));
  }
}

void check(const Material& material) {
  check_positive("young", material.young);
  if (!(material.poisson > -1 && material.poisson < 0.5)) {
    throw std::invalid_argument(fmt::format("poisson = {} is not allowed: it must lie in (-1, 0.5)", material.poisson));
  }
}

} // namespace boba::continuum
