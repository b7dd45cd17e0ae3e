// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/observer.h"
#include "bpm/dynamics/stage.h"
#include "bpm/dynamics/stepper.h"

#include <memory>

namespace boba {

/// What a stage does around each step. One class a stage; to add a stage, add a struct to stage.h, a driver, and a line
/// to make_stage_driver.
class StageDriver {
public:
  virtual ~StageDriver() = default;
  /// Called once when the stage begins (not when a stored run goes on in it).
  virtual void begin(Stepper& stepper) = 0;
  /// Does `cell_rates` or `update` read the pressure of this step?
  virtual bool needs_pressure() const = 0;
  /// After the forces of a step: decides how the cell moves at its end, and looks whether the stage is over.
  virtual CellRates update(Stepper& stepper) = 0;
  virtual bool finished() const = 0;
  /// Number of steps left when it is known beforehand, -1 otherwise.
  virtual std::int64_t steps_left(const Stepper& stepper) const = 0;
  /// May the stage end with the next step? Its stress is then computed, for whoever looks at the stage's end.
  virtual bool may_end(const Stepper& stepper) const { return steps_left(stepper) == 1; }
  /// Called when the stage is over.
  virtual void end(Stepper&) {}
  /// Fills phase, share done, driven quantity, value and target.
  virtual StageProgress progress(const Stepper& stepper) const = 0;
  virtual void save(SavedState& saved) const = 0;
  virtual void restore(const SavedState& saved, Stepper& stepper) = 0;
};

std::unique_ptr<StageDriver> make_stage_driver(const Stage& stage);

} // namespace boba
