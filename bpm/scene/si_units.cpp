// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/si_units.h"

#include "bpm/grain/template_spec.h"

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <stdexcept>

namespace boba {

namespace {

void check_positive(double value, const char* name) {
  if (!std::isfinite(value) || !(value > 0.0)) {
    throw std::invalid_argument(fmt::format("{} {:g}: must be above 0", name, value));
  }
}

} // namespace

double SiUnits::time() const {
  return std::sqrt(mass / stiffness);
}

SiUnits si_units(const SiGrain& grain, const PoissonTable& table) {
  check_positive(grain.young, "Young's modulus");
  check_positive(grain.diameter, "diameter");
  check_positive(grain.density, "density");
  if (grain.nodes < 1) {
    throw std::invalid_argument(fmt::format("{} nodes: a grain has at least 1", grain.nodes));
  }
  const double bulk = TemplateSpec{}.density;
  SiUnits units;
  units.length = grain.diameter / std::cbrt(6.0 * grain.nodes / (std::numbers::pi * bulk));
  units.mass = grain.density * units.length * units.length * units.length / bulk;
  units.alpha = table.alpha_of_poisson(grain.poisson, 1.0);
  units.young = table.young(units.alpha, 1.0);
  units.effective = units.young / (2.0 - 2.0 * grain.poisson * grain.poisson);
  units.stiffness = grain.young * units.length / units.young;
  return units;
}

double inertial_number_of(const SiGrain& grain, double rate, double pressure) {
  check_positive(pressure, "pressure");
  return std::abs(rate) * grain.diameter * std::sqrt(grain.density / pressure);
}

} // namespace boba
