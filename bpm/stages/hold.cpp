// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/hold.h"

namespace boba {

void HoldDriver::begin(Stepper& stepper) {
  steps_.begin(stage_.time, stepper.options().dt);
  pressure_.begin(stepper, 0.0);
}

CellRates HoldDriver::update(Stepper& stepper) {
  steps_.count();
  return {.dilation = pressure_.dilation_rate(stepper)};
}

StageProgress HoldDriver::progress(const Stepper& stepper) const {
  StageProgress progress;
  progress.done = steps_.share_done();
  progress.driven = "time";
  progress.target = stage_.time;
  progress.value = static_cast<double>(steps_.done()) * stepper.options().dt;
  return progress;
}

void HoldDriver::save(SavedState& saved) const {
  steps_.save(saved);
  pressure_.save(saved);
}

void HoldDriver::restore(const SavedState& saved) {
  steps_.restore(saved);
  pressure_.restore(saved);
}

} // namespace boba
