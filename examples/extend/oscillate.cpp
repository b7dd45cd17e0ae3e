// SPDX-License-Identifier: GPL-3.0-or-later
#include "oscillate.h"

#include <bpm/dynamics/stepper.h>
#include <cmath>
#include <numbers>

using namespace boba;

void OscillateDriver::begin(Stepper& stepper) {
  dt_ = stepper.options().dt;
  steps_.begin(static_cast<double>(stage_.cycles) * stage_.period, dt_);
}

double OscillateDriver::strain_after(std::int64_t steps) const {
  const double time = static_cast<double>(steps) * dt_;
  return stage_.amplitude * std::sin(2.0 * std::numbers::pi * time / stage_.period);
}

/// The rate that takes the strain from this step to the next, so that no error of the sine adds up.
double OscillateDriver::shear_rate() const {
  return dt_ > 0.0 ? (strain_after(steps_.done() + 1) - strain_after(steps_.done())) / dt_ : 0.0;
}

CellRates OscillateDriver::update(Stepper&) {
  const double rate = shear_rate();
  steps_.count();
  return {.shear = rate};
}

StageProgress OscillateDriver::progress(const Stepper&) const {
  StageProgress progress;
  progress.done = steps_.share_done();
  progress.driven = "cycles";
  progress.target = static_cast<double>(stage_.cycles);
  progress.value = static_cast<double>(steps_.done()) * dt_ / stage_.period;
  return progress;
}

void OscillateDriver::archive(Archive& archive) {
  archive.object("steps", steps_);
  archive.field("dt", dt_);
}

SceneSection OscillateEntry::section() {
  return {"stage",
          "oscillate",
          true,
          "Shears to and fro at constant volume: strain = amplitude sin(2 pi t / period).",
          {required(above_key("amplitude", "", 0.0, 1.0, "", "largest strain")),
           required(above_key("period", "tau", 0.0, 1e9, "", "of one cycle")),
           integer_key("cycles", 1.0, 1e6, "1", "how many")}};
}

OscillateEntry::OscillateEntry(const SceneTable& table)
    : stage_{table.real("amplitude", 0.0), table.real("period", 0.0), table.integer("cycles", 1)} {}

void OscillateEntry::check(const SceneTable& table, const StageSurroundings& surroundings) const {
  require_periodic_cell(table, surroundings);
  require_countable_steps(table, "period", static_cast<double>(stage_.cycles) * stage_.period, surroundings.dt);
}

StageLength OscillateEntry::estimate(const StageContext&) const {
  return {.time = static_cast<double>(stage_.cycles) * stage_.period};
}

std::unique_ptr<StageDriver> OscillateEntry::make_driver(const StageContext&) const {
  return std::make_unique<OscillateDriver>(stage_);
}
