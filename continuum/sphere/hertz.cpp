// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/sphere/hertz.h"

#include <cmath>
#include <numbers>

namespace boba::continuum {

Hertz hertz(double radius, const Material& material, double approach) {
  Hertz result{};
  result.contact_radius = std::sqrt(radius * approach);
  result.force = 4. / 3 * material.plane() * result.contact_radius * approach;
  result.peak_pressure = 1.5 * result.force / (std::numbers::pi * result.contact_radius * result.contact_radius);
  return result;
}

double tatara_approach(double radius, const Material& material, double force, double contact_radius) {
  const double nu = material.poisson;
  const double square = contact_radius * contact_radius + 4 * radius * radius;
  const double f = 2 * (1 + nu) * radius * radius / std::pow(square, 1.5) + (1 - nu * nu) / std::sqrt(square);
  return 3 * (1 - nu * nu) * force / (4 * material.young * contact_radius) -
         force * f / (std::numbers::pi * material.young);
}

} // namespace boba::continuum
