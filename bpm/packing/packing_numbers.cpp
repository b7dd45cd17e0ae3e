// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/packing_numbers.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace boba {

PackingNumbers::PackingNumbers(const Packing& packing, const Material& material,
                               std::optional<double> effective_modulus)
    : modulus(effective_modulus), n_nodes(packing.first_nodes().back()) {
  for (int g = 0; g < packing.n_grains(); ++g) {
    reference_volume += packing.template_of(g).reference_volume;
  }
  grain_diameter = std::cbrt(6.0 * reference_volume / packing.n_grains() / std::numbers::pi);
  density = material.node_mass * static_cast<double>(n_nodes) / reference_volume;
}

double PackingNumbers::normalised(double pressure) const {
  return modulus ? pressure / *modulus : std::numeric_limits<double>::quiet_NaN();
}

double PackingNumbers::phi_reference(const Box& box) const {
  return reference_volume / box.volume();
}

double PackingNumbers::inertial_number(double rate, double pressure) const {
  return boba::inertial_number(rate, grain_diameter, density, pressure);
}

double inertial_number(double rate, double diameter, double density, double pressure) {
  if (rate == 0.0) {
    return 0.0;
  }
  return pressure > 0.0 ? std::abs(rate) * diameter * std::sqrt(density / pressure)
                        : std::numeric_limits<double>::quiet_NaN();
}

} // namespace boba
