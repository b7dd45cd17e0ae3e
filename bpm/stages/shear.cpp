// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/shear.h"

#include "bpm/dynamics/stepper.h"
#include "bpm/stages/deform.h"
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

SceneSection ShearEntry::section() {
  return {"stage", "shear", true, "Simple shear, of itself in x with gradient y.",
          joined({required(real_key("rate", "1/tau", -0.1, 0.1, "", "shear rate, not 0; negative shears backwards")),
                  required(above_key("strain", "", 0.0, 1e6, "", "strain to add")),
                  choice_key("remap", {"positions", "velocities"}, "\"positions\"",
                             "nodes follow the cell affinely, or only images across the cell carry its velocity"),
                  choice_key("plane", {"xy", "xz", "yz"}, "\"xy\"", "direction of the flow and of its gradient"),
                  choice_key("hold", {"pressure", "normal_stress", "volume"}, "",
                             "default: the pressure where one is given, else the volume. normal_stress: that along the "
                             "gradient is minus the pressure, and only the cell's length along the gradient moves")},
                 pressure_keys("; without it the volume is constant"))};
}

namespace {

/// The same shear as a deformation of the cell, for any plane and either thing to hold.
DeformStage as_deformation(const ShearStage& shear, int plane, bool holds_normal_stress) {
  using Kind = ComponentDrive::Kind;
  DeformStage stage;
  stage.kind = "shear";
  stage.measure = StrainMeasure::logarithmic;
  stage.time = shear.strain / std::abs(shear.rate);
  stage.remap = shear.remap;
  stage.component[plane].kind = Kind::strain;
  stage.component[plane].path = {.duration = stage.time, .rate_from = shear.rate, .rate = shear.rate};
  if (!shear.barostat) {
    return stage;
  }
  if (holds_normal_stress) {
    ComponentDrive& gradient = stage.component[component_place[plane][1]];
    gradient.kind = Kind::stress;
    gradient.stress = -shear.barostat->pressure;
    stage.servo = *shear.barostat;
    return stage;
  }
  stage.pressure = shear.barostat;
  for (int c = 0; c < 3; ++c) {
    stage.component[c].kind = Kind::pressure;
  }
  return stage;
}

} // namespace

ShearEntry::ShearEntry(const SceneTable& table) : pressure_(table) {
  parameters_.rate = table.real("rate", 0.0);
  if (parameters_.rate == 0.0) {
    table.fail("rate", "must not be 0");
  }
  parameters_.strain = table.real("strain", 0.0);
  plane_ = table.text("plane", "xy") == "xy" ? 3 : table.text("plane", "xy") == "xz" ? 4 : 5;
  const std::string hold = table.text("hold", pressure_.is_given() ? "pressure" : "volume");
  holds_normal_stress_ = hold == "normal_stress";
  if ((hold == "volume") == pressure_.is_given()) {
    table.fail("hold", pressure_.is_given() ? "leaves no use for a pressure" : "needs pressure or normalised_pressure");
  }
  if (plane_ != 3 && table.text("remap", "positions") == "velocities") {
    table.fail("remap", "= \"velocities\" is for the plane xy");
  }
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
  if (!is_plain()) {
    return std::make_unique<DeformDriver>(as_deformation(stage, plane_, holds_normal_stress_));
  }
  return std::make_unique<ShearDriver>(stage);
}

} // namespace boba
