// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/command.h"
#include "bpm/scene/si_units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace boba {

namespace {

struct UnitsArguments {
  SiGrain grain;
  std::optional<double> pressure; ///< Pa
  std::optional<double> rate;     ///< 1/s
  double dt = 0.1;                ///< tau
  std::vector<std::string> to_si;
};

/// A quantity that results hold, and what its unit is in SI units.
struct Quantity {
  std::string_view name, unit, si;
  double (*size)(const SiUnits& units);
};

constexpr std::array quantities = {
    Quantity{"length", "d", "m", [](const SiUnits& u) { return u.length; }},
    Quantity{"mass", "m", "kg", [](const SiUnits& u) { return u.mass; }},
    Quantity{"stiffness", "k", "N/m", [](const SiUnits& u) { return u.stiffness; }},
    Quantity{"time", "tau", "s", [](const SiUnits& u) { return u.time(); }},
    Quantity{"rate", "1/tau", "1/s", [](const SiUnits& u) { return 1.0 / u.time(); }},
    Quantity{"velocity", "d/tau", "m/s", [](const SiUnits& u) { return u.velocity(); }},
    Quantity{"force", "k d", "N", [](const SiUnits& u) { return u.force(); }},
    Quantity{"pressure", "k/d", "Pa", [](const SiUnits& u) { return u.pressure(); }},
    Quantity{"energy", "k d^2", "J", [](const SiUnits& u) { return u.energy(); }},
};

std::string names_of_quantities() {
  std::string names;
  for (const Quantity& quantity : quantities) {
    names += (names.empty() ? "" : ", ") + std::string(quantity.name);
  }
  return names;
}

/// NAME=NUMBER of the engine's units as a line in SI units.
std::string in_si(const std::string& text, const SiUnits& units) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, equals);
  double value = 0.0;
  const char* first = equals == std::string::npos ? text.data() : text.data() + equals + 1;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, value);
  if (equals == std::string::npos || error != std::errc() || end != last || !std::isfinite(value)) {
    throw std::invalid_argument(
        fmt::format("--to-si {}: write QUANTITY=NUMBER, as pressure=0.1; quantities: {}", text, names_of_quantities()));
  }
  for (const Quantity& quantity : quantities) {
    if (quantity.name == name) {
      return fmt::format("{} {:g} {} = {:.4g} {}", name, value, quantity.unit, value * quantity.size(units),
                         quantity.si);
    }
  }
  throw std::invalid_argument(
      fmt::format("--to-si {}: there is no quantity {}; there are {}", text, name, names_of_quantities()));
}

void print_units(const UnitsArguments& a, const SiUnits& units) {
  const SiGrain& grain = a.grain;
  fmt::print("grain: {:g} m across, E {:g} Pa, nu {:g}, {:g} kg/m^3, {} node{}\n", grain.diameter, grain.young,
             grain.poisson, grain.density, grain.nodes, grain.nodes == 1 ? "" : "s");
  for (const Quantity& quantity : quantities) {
    fmt::print("  {:<9} 1 {:<5} = {:.4g} {}\n", quantity.name, quantity.unit, quantity.size(units), quantity.si);
  }
  fmt::print("material: alpha {:.4g} k d, E {:.4g} k/d, E / (2 - 2 nu^2) {:.4g} k/d\n", units.alpha, units.young,
             units.effective);
  fmt::print("grain's diameter: {:.4g} d; time step {:g} tau = {:.4g} s\n", grain.diameter / units.length, a.dt,
             a.dt * units.time());
}

void print_loading(const UnitsArguments& a, const SiUnits& units) {
  if (a.pressure) {
    const double pressure = *a.pressure / units.pressure();
    fmt::print("pressure {:g} Pa: P {:.4g} k/d, normalised P~ {:.4g}\n", *a.pressure, pressure,
               pressure / units.effective);
  }
  if (a.rate) {
    const double rate = *a.rate * units.time();
    fmt::print("rate {:g} 1/s: {:.4g} 1/tau, {:.3g} steps for a strain of 1\n", *a.rate, rate, 1.0 / (rate * a.dt));
  }
  if (a.pressure && a.rate) {
    const double number = inertial_number_of(a.grain, *a.rate, *a.pressure);
    fmt::print("inertial number I: {:.3g}\n", number);
    const double rate = *a.rate * units.time() * 1e-3 / number;
    fmt::print("  a rate of {:.3g} 1/tau has I = 1e-3, {:.3g} steps for a strain of 1; where I is small, its value "
               "matters little\n",
               rate, 1.0 / (rate * a.dt));
  }
}

void print_scene(const UnitsArguments& a, const SiUnits& units) {
  fmt::print("in a scene:\n\n[[template]]\nname = \"grain\"\nnodes = {}\n\n[[species]]\ntemplate = \"grain\"\n"
             "count = 64\npoisson = {:g}\n",
             a.grain.nodes, a.grain.poisson);
  if (a.pressure) {
    fmt::print("\n[[stage]]\ntype = \"compress\"\nnormalised_pressure = {:.4g}\n",
               *a.pressure / units.pressure() / units.effective);
  }
}

ExitCode compute(const UnitsArguments& a) {
  if (!(a.dt > 0.0 && a.dt <= 1.0)) {
    throw std::invalid_argument(fmt::format("--dt {:g}: must be above 0 and at most 1 (tau)", a.dt));
  }
  if (a.rate && !(std::isfinite(*a.rate) && *a.rate > 0.0)) {
    throw std::invalid_argument(fmt::format("--rate {:g}: must be above 0 (1/s)", *a.rate));
  }
  if (a.pressure && !(std::isfinite(*a.pressure) && *a.pressure > 0.0)) {
    throw std::invalid_argument(fmt::format("--pressure {:g}: must be above 0 (Pa)", *a.pressure));
  }
  const PoissonTable table = PoissonTable::installed();
  const double highest = table.poisson(table.alpha_range()[0], 1.0),
               lowest = table.poisson(table.alpha_range()[1], 1.0);
  if (!(a.grain.poisson >= lowest && a.grain.poisson <= highest)) {
    throw std::invalid_argument(
        fmt::format("--poisson {:g}: a network of nodes can have {:.3f} to {:.3f}", a.grain.poisson, lowest, highest));
  }
  const SiUnits units = si_units(a.grain, table);
  std::string converted;
  for (const std::string& text : a.to_si) {
    converted += in_si(text, units) + "\n";
  }
  if (!converted.empty()) {
    fmt::print("{}", converted);
    return ExitCode::done;
  }
  print_units(a, units);
  print_loading(a, units);
  print_scene(a, units);
  return ExitCode::done;
}

/// A number, alone (SI) or with one of the units.
CLI::AsNumberWithUnit with_unit(const std::map<std::string, double>& units, const std::string& name) {
  return CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::CASE_SENSITIVE, name);
}

} // namespace

CommandBody add_units_command(CLI::App& app) {
  auto a = std::make_shared<UnitsArguments>();
  a->grain.nodes = 1000;
  const CLI::AsNumberWithUnit pressure = with_unit({{"Pa", 1.0}, {"kPa", 1e3}, {"MPa", 1e6}, {"GPa", 1e9}}, "PRESSURE");
  const CLI::AsNumberWithUnit length =
      with_unit({{"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}}, "LENGTH");
  app.add_option("--young", a->grain.young, "Young's modulus: 20kPa, 0.02MPa, 20000 (Pa)")
      ->required()
      ->transform(pressure);
  app.add_option("--poisson", a->grain.poisson, "Poisson's ratio")->required();
  app.add_option("--diameter", a->grain.diameter, "diameter of a grain: 3mm, 0.003 (m)")->required()->transform(length);
  app.add_option("--density", a->grain.density, "mass density, kg/m^3")->required();
  app.add_option("--nodes", a->grain.nodes, "nodes per grain")->capture_default_str();
  app.add_option("--pressure", a->pressure, "pressure of the packing: 500Pa, 0.5kPa, 500")->transform(pressure);
  app.add_option("--rate", a->rate, "shear rate, 1/s");
  app.add_option("--dt", a->dt, "time step, tau")->capture_default_str();
  app.add_option("--to-si", a->to_si, "instead: numbers of a run in SI units, as pressure=0.2 time=1000")
      ->type_name("QUANTITY=NUMBER");
  app.footer("The grain is a sphere. Its network gets the modulus, the ratio, the volume and the mass that are given.");
  return [a] { return compute(*a); };
}

} // namespace boba
