// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace boba {

class Simulation;

/// Where a stage stands: what a progress bar draws.
struct StageProgress {
  int stage = 0;           ///< index among the scene's stages
  std::string name;        ///< "compress", ...
  std::string phase;       ///< "ramp", "settle" or ""
  double done = 0.0;       ///< share of the stage, 0 .. 1, as far as it can be known
  std::string driven;      ///< name of the quantity the stage drives: "P", "strain", "time"
  double value = 0.0;      ///< its present value
  double target = 0.0;     ///< its target
  double shear_rate = 0.0; ///< of the cell, 1/tau
};

/// What a step will be when it is done: known before the step, so that an observer can ask for what it needs.
struct StepForecast {
  std::int64_t step = 0;
  double time = 0.0;
  double strain = 0.0;
  bool last_of_stage = false; ///< true when the stage is known to end with this step
  double seconds = 0.0;       ///< real time since the simulation was made, the same on all ranks
};

/// Something that looks at a run: writers, measures, the progress bar. The dynamics knows only this interface.
class Observer {
public:
  virtual ~Observer() = default;
  /// Asked before every step: does this observer want to see it (with the full stress tensor evaluated)? All ranks must
  /// answer alike: whoever goes by real time takes the forecast's.
  virtual bool wants(const StepForecast& forecast) = 0;
  /// Called after each step it asked for, and with the state before the first and after the last step of every stage
  /// (the same step may thus come more than once).
  virtual void observe(const Simulation& simulation, const StageProgress& progress) = 0;
};

} // namespace boba
