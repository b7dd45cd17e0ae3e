// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/timed_driver.h"

#include "bpm/dynamics/step_count.h"

#include <cmath>

namespace boba {

TimedDriver::TimedDriver(const HoldStage& stage) : hold_time_(stage.time) {
  shear_.barostat = stage.barostat;
}

void TimedDriver::begin(Stepper& stepper) {
  const double duration = is_shear_ ? shear_.strain / std::abs(shear_.rate) : hold_time_;
  n_steps_ = step_count(duration, stepper.options().dt);
  if (shear_.barostat) {
    const double modulus = shear_.barostat->gain ? 1.0 : stepper.affine_bulk_modulus();
    gain_ = barostat_gain(*shear_.barostat, {modulus, stepper.sound_crossing(modulus), shear_.rate});
  }
  if (shear_.remap == Remap::velocities) {
    stepper.add_streaming(shear_.rate, 1.0);
  }
}

CellRates TimedDriver::update(Stepper& stepper) {
  ++steps_done_;
  CellRates rates{.shear = shear_.rate, .remap = shear_.remap};
  if (shear_.barostat) {
    rates.dilation = barostat_rate(*shear_.barostat, gain_, stepper.pressure());
  }
  return rates;
}

void TimedDriver::end(Stepper& stepper) {
  if (shear_.remap == Remap::velocities) {
    stepper.add_streaming(shear_.rate, -1.0);
  }
}

StageProgress TimedDriver::progress(const Stepper& stepper) const {
  StageProgress progress;
  progress.done = n_steps_ > 0 ? static_cast<double>(steps_done_) / static_cast<double>(n_steps_) : 1.0;
  progress.driven = is_shear_ ? "strain" : "time";
  progress.target = is_shear_ ? shear_.strain : hold_time_;
  progress.value = static_cast<double>(steps_done_) * stepper.options().dt * (is_shear_ ? std::abs(shear_.rate) : 1.0);
  return progress;
}

void TimedDriver::save(SavedState& saved) const {
  saved.real["driver"] = {gain_};
  saved.integer["driver"] = {n_steps_, steps_done_};
}

void TimedDriver::restore(const SavedState& saved, Stepper&) {
  gain_ = saved.real.at("driver").at(0);
  n_steps_ = saved.integer.at("driver").at(0);
  steps_done_ = saved.integer.at("driver").at(1);
}

} // namespace boba
