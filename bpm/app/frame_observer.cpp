// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/frame_observer.h"

namespace boba {

bool FrameObserver::wants(const StepForecast& forecast) {
  const bool due = schedule_.due(forecast); // asked at every step, whatever else is true
  return due || forecast.last_of_stage;
}

void FrameObserver::observe(const Simulation& simulation, const StageProgress&) {
  if (simulation.step() <= last_step_) {
    return; // the end of one stage is the beginning of the next
  }
  last_step_ = simulation.step();
  write_(simulation.snapshot(parts_));
}

} // namespace boba
