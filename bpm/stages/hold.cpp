// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/hold.h"

#include "bpm/dynamics/stepper.h"
#include "bpm/toml/schema.h"

namespace boba {

void HoldDriver::begin(Stepper& stepper) {
  steps_.begin(stage_.time, stepper.options().dt);
  pressure_.begin(stepper, 0.0);
}

CellRates HoldDriver::update(Stepper& stepper) {
  steps_.count();
  return {.dilation = pressure_.dilation_rate(stepper, steps_.share_done())};
}

StageProgress HoldDriver::progress(const Stepper& stepper) const {
  return progress_in_time(steps_, stage_.time, stepper.options().dt);
}

SceneSection HoldEntry::section() {
  return {"stage", "hold", true, "A fixed cell, or a held pressure, for a time.",
          joined({required(above_key("time", "tau", 0.0, 1e12, "", "how long"))},
                 pressure_keys("; without it the cell is fixed"))};
}

HoldEntry::HoldEntry(const SceneTable& table) : pressure_(table) {
  parameters_.time = table.real("time", 0.0);
}

void HoldEntry::check(const SceneTable& table, const StageSurroundings& surroundings) const {
  if (pressure_.is_given()) {
    require_periodic_cell(table, surroundings);
  }
  require_countable_steps(table, "time", parameters_.time, surroundings.dt);
}

StageLength HoldEntry::estimate(const StageContext&) const {
  return {.time = parameters_.time};
}

std::unique_ptr<StageDriver> HoldEntry::make_driver(const StageContext& context) const {
  HoldStage stage = parameters_;
  stage.barostat = pressure_.barostat(context);
  return std::make_unique<HoldDriver>(stage);
}

} // namespace boba
