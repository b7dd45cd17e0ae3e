// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/shear.h"

#include "bpm/dynamics/stepper.h"
#include "bpm/toml/schema.h"

#include <cmath>

namespace boba {

void ShearDriver::begin(Stepper& stepper) {
  steps_.begin(stage_.strain / std::abs(stage_.rate), stepper.options().dt);
  pressure_.begin(stepper, stage_.rate);
}

CellRates ShearDriver::update(Stepper& stepper) {
  steps_.count();
  return {
      .shear = stage_.rate, .remap = stage_.remap, .dilation = pressure_.dilation_rate(stepper, steps_.share_done())};
}

StageProgress ShearDriver::progress(const Stepper& stepper) const {
  StageProgress progress;
  progress.done = steps_.share_done();
  progress.driven = "strain";
  progress.target = stage_.strain;
  progress.value = static_cast<double>(steps_.done()) * stepper.options().dt * std::abs(stage_.rate);
  return progress;
}

void ShearDriver::archive(Archive& archive) {
  archive.object("steps", steps_);
  archive.object("pressure", pressure_);
}

SceneSection ShearEntry::section() {
  return {"stage", "shear", true, "Simple shear in x with gradient y.",
          joined({required(real_key("rate", "1/tau", -0.1, 0.1, "", "shear rate, not 0; negative shears backwards")),
                  required(above_key("strain", "", 0.0, 1e6, "", "strain to add")),
                  choice_key("remap", {"positions", "velocities"}, "\"positions\"",
                             "nodes follow the cell affinely, or only images across the cell carry its velocity")},
                 pressure_keys("; without it the volume is constant"))};
}

ShearEntry::ShearEntry(const SceneTable& table) : pressure_(table) {
  parameters_.rate = table.real("rate", 0.0);
  if (parameters_.rate == 0.0) {
    table.fail("rate", "must not be 0");
  }
  parameters_.strain = table.real("strain", 0.0);
  parameters_.remap = table.text("remap", "positions") == "positions" ? Remap::positions : Remap::velocities;
}

void ShearEntry::check(const SceneTable& table, const StageSurroundings& surroundings) const {
  require_periodic_cell(table, surroundings);
  require_countable_steps(table, "rate", parameters_.strain / std::abs(parameters_.rate), surroundings.dt);
}

StageLength ShearEntry::estimate(const StageContext&) const {
  return {.time = parameters_.strain / std::abs(parameters_.rate)};
}

std::unique_ptr<StageDriver> ShearEntry::make_driver(const StageContext& context) const {
  ShearStage stage = parameters_;
  stage.barostat = pressure_.barostat(context);
  return std::make_unique<ShearDriver>(stage);
}

} // namespace boba
