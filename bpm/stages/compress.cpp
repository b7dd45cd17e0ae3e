// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/compress.h"

#include "bpm/dynamics/elastic_probe.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/toml/schema.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

/// Steps between two looks at the elastic energy while settling: it takes a pass over all bonds.
constexpr std::int64_t settle_interval = 20;

} // namespace

void CompressDriver::begin(Stepper& stepper) {
  start_time_ = stepper.time();
}

bool CompressDriver::has_settled(const Stepper& stepper) const {
  if (std::abs(stepper.pressure() / stage_.barostat.pressure - 1.0) >= stage_.pressure_tolerance ||
      stepper.step() % settle_interval != 0) {
    return false;
  }
  const double elastic = stepper.bond_energy() + stepper.forces().contact_totals().energy;
  return stepper.kinetic_energy() < stage_.kinetic_tolerance * elastic;
}

bool CompressDriver::may_end(const Stepper& stepper) const {
  return phase_ == Phase::settle && (stepper.step() + 1) % settle_interval == 0;
}

/// The modulus that the barostat has to do with: dP / d ln(1/V) of the second half of the ramp. Grains that rearrange
/// answer to a change of volume with a fraction of the affine modulus, which is the most it can be.
double CompressDriver::bulk_modulus(Stepper& stepper) const {
  const double affine = affine_bulk_modulus(stepper.moving());
  const double compressed = 3.0 * stage_.rate * (stepper.time() - halfway_.time);
  return compressed > 0.0 ? std::min(affine, (stepper.pressure() - halfway_.pressure) / compressed) : affine;
}

CellRates CompressDriver::update(Stepper& stepper) {
  if (stepper.time() - start_time_ > stage_.max_time) {
    throw std::runtime_error(fmt::format(
        "compress: not settled after max_time = {} tau: P = {:.6g} (target {:.6g} k/d), kinetic energy {:.3g} k d^2; "
        "a smaller rate, a larger max_time or wider tolerances help",
        stage_.max_time, stepper.pressure(), stage_.barostat.pressure, stepper.kinetic_energy()));
  }
  const bool may_end_here = phase_ == Phase::settle; // as may_end said: not in the step that ends the ramp
  if (phase_ == Phase::ramp && halfway_.time < 0.0 && stepper.pressure() >= 0.5 * stage_.barostat.pressure) {
    halfway_ = {stepper.time(), stepper.pressure()};
  }
  if (phase_ == Phase::ramp && stepper.pressure() >= stage_.barostat.pressure) {
    const double modulus = bulk_modulus(stepper);
    gain_ = barostat_gain(stage_.barostat, {modulus, sound_crossing(stepper.moving(), modulus), 0.0});
    phase_ = Phase::settle;
  }
  if (phase_ == Phase::ramp) {
    return {.dilation = -stage_.rate};
  }
  if (may_end_here && has_settled(stepper)) {
    phase_ = Phase::settled;
    return {};
  }
  return {.dilation = barostat_rate(stage_.barostat, gain_, stepper.pressure())};
}

StageProgress CompressDriver::progress(const Stepper& stepper) const {
  StageProgress progress{.phase = phase_ == Phase::ramp ? "ramp" : "settle", .driven = "P"};
  progress.value = stepper.pressure();
  progress.target = stage_.barostat.pressure;
  const double reached = std::clamp(stepper.pressure() / stage_.barostat.pressure, 0.0, 1.0);
  progress.done = phase_ == Phase::ramp ? 0.8 * reached : (finished() ? 1.0 : 0.9);
  return progress;
}

void CompressDriver::archive(Archive& archive) {
  archive.field("phase", phase_, Phase::settled);
  archive.field("start_time", start_time_);
  archive.field("gain", gain_);
  archive.field("halfway_time", halfway_.time);
  archive.field("halfway_pressure", halfway_.pressure);
}

SceneSection CompressEntry::section() {
  return {"stage", "compress", true,
          "Isotropic compression at a constant rate up to the pressure, then a hold under the barostat until both "
          "tolerances are met.",
          joined(pressure_keys(" (this or `normalised_pressure`)"),
                 {above_key("rate", "1/tau", 0.0, 0.1, "5e-4", "-d ln L / dt of the ramp"),
                  above_key("pressure_tolerance", "", 0.0, 1.0, "1e-3", "|P / P_target - 1| at the end"),
                  above_key("kinetic_tolerance", "", 0.0, 1e3, "1e-4", "kinetic over elastic energy at the end"),
                  above_key("max_time", "tau", 0.0, 1e12, "1e6", "the stage fails when it has not settled by then")})};
}

CompressEntry::CompressEntry(const SceneTable& table) : pressure_(table) {
  if (!pressure_.is_given()) {
    table.fail("pressure", "or normalised_pressure must be given");
  }
  parameters_.rate = table.real("rate", parameters_.rate);
  parameters_.pressure_tolerance = table.real("pressure_tolerance", parameters_.pressure_tolerance);
  parameters_.kinetic_tolerance = table.real("kinetic_tolerance", parameters_.kinetic_tolerance);
  parameters_.max_time = table.real("max_time", parameters_.max_time);
}

void CompressEntry::check(const SceneTable& table, const StageSurroundings& surroundings) const {
  require_periodic_cell(table, surroundings);
}

// Packings of spheres end at phi = 0.6 + 0.27 (P~ / 0.1)^(2/3), with phi counted to d/2 outside the nodes; settling
// takes about a fifth more.
// Source: Clemmer, Hackney & Grest: phi_c about 0.6, P~ ~ (phi - phi_c)^(3/2), phi about 0.87 at P~ = 0.1.
StageLength CompressEntry::estimate(const StageContext& context) const {
  const PackingNumbers& numbers = context.numbers;
  const double p = numbers.normalised(pressure_.barostat(context)->pressure);
  const double phi = 0.6 + 0.27 * std::pow(std::max(p, 0.0) / 0.1, 2.0 / 3.0);
  const double with_shell = std::pow(1.0 + 1.0 / numbers.grain_diameter, 3); // d/2 around a sphere
  const double now = numbers.phi_reference(context.packing.box) * with_shell;
  constexpr double settling = 1.2;
  const double time = std::isfinite(phi) && phi > now ? settling * std::log(phi / now) / 3.0 / parameters_.rate : 0.0;
  return {.time = time, .is_exact = false};
}

std::unique_ptr<StageDriver> CompressEntry::make_driver(const StageContext& context) const {
  CompressStage stage = parameters_;
  stage.barostat = *pressure_.barostat(context);
  return std::make_unique<CompressDriver>(stage);
}

} // namespace boba
