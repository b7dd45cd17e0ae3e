// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/archive.h"
#include "bpm/dynamics/moving_cell.h"
#include "bpm/dynamics/observer.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/dynamics/stage_table.h"

#include <cstdint>
#include <string>

namespace boba {

class Stepper;

/// What a stage does around each step; one class per stage (bpm/stages). Simulation::run calls it.
///
/// With several ranks all make the same calls with the same answers.
class StageDriver {
public:
  virtual ~StageDriver() = default;
  /// What the stage is called in scenes, tables and messages: "shear".
  virtual std::string name() const = 0;
  /// Called once when the stage begins, not when a stored run continues in it.
  virtual void begin(Stepper& stepper) = 0;
  /// Does `update` read the pressure of every step?
  virtual bool needs_pressure() const = 0;
  /// Does it read all components of the stress (stress_of) of every step?
  virtual bool needs_stress() const { return false; }
  /// After the forces of a step: decides how the cell moves at its end, and looks whether the stage is over.
  virtual CellRates update(Stepper& stepper) = 0;
  virtual bool finished() const = 0;
  /// Number of steps left when it is known beforehand, -1 otherwise.
  virtual std::int64_t steps_left(const Stepper& stepper) const = 0;
  /// May the stage end with the next step? Its stress is then computed, for whoever looks at the stage's end.
  virtual bool may_end(const Stepper& stepper) const = 0;
  /// Shear rate of the cell in the next step, 1/tau: what strain the step will add, and the inertial number.
  virtual double shear_rate() const = 0;
  /// Called when the stage is over.
  virtual void end(Stepper& stepper) = 0;
  /// Fills phase, share done, driven quantity, value and target.
  virtual StageProgress progress(const Stepper& stepper) const = 0;
  /// What is to be said at the stage's end beside the means: how well it held what it was to hold. "" where nothing is.
  virtual std::string report() const { return ""; }
  /// Did it hold something and miss its target? Known at its end.
  virtual bool has_missed() const { return false; }
  /// A table of the stage's own, to be written when it has ended; null without one.
  virtual const StageTable* table() const { return nullptr; }
  /// All that the stage needs to continue bit for bit, field by field.
  virtual void archive(Archive& archive) = 0;
};

} // namespace boba
