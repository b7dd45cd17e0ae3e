// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/shear.h"

#include <cmath>

namespace boba {

void ShearDriver::begin(Stepper& stepper) {
  steps_.begin(stage_.strain / std::abs(stage_.rate), stepper.options().dt);
  pressure_.begin(stepper, stage_.rate);
  if (stage_.remap == Remap::velocities) {
    stepper.add_streaming(stage_.rate, 1.0);
  }
}

CellRates ShearDriver::update(Stepper& stepper) {
  steps_.count();
  return {.shear = stage_.rate, .remap = stage_.remap, .dilation = pressure_.dilation_rate(stepper)};
}

void ShearDriver::end(Stepper& stepper) {
  if (stage_.remap == Remap::velocities) {
    stepper.add_streaming(stage_.rate, -1.0);
  }
}

StageProgress ShearDriver::progress(const Stepper& stepper) const {
  StageProgress progress;
  progress.done = steps_.share_done();
  progress.driven = "strain";
  progress.target = stage_.strain;
  progress.value = static_cast<double>(steps_.done()) * stepper.options().dt * std::abs(stage_.rate);
  return progress;
}

void ShearDriver::save(SavedState& saved) const {
  steps_.save(saved);
  pressure_.save(saved);
}

void ShearDriver::restore(const SavedState& saved) {
  steps_.restore(saved);
  pressure_.restore(saved);
}

} // namespace boba
