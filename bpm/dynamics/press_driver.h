// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stage_driver.h"

namespace boba {

/// Squeezes (or, with clamps, pulls) a specimen along z between two walls or two clamped ends.
class PressDriver : public StageDriver {
public:
  explicit PressDriver(const PressStage& stage) : stage_(stage) {}

  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return false; }
  CellRates update(Stepper& stepper) override;
  bool finished() const override { return steps_done_ >= n_steps_; }
  std::int64_t steps_left(const Stepper&) const override { return n_steps_ - steps_done_; }
  void end(Stepper& stepper) override;
  StageProgress progress(const Stepper& stepper) const override;
  void save(SavedState& saved) const override;
  void restore(const SavedState& saved, Stepper& stepper) override;

private:
  void begin_walls(Stepper& stepper);
  void begin_clamps(Stepper& stepper);
  double moved() const; ///< by each end so far, d

  PressStage stage_;
  double height_ = 0.0; ///< between the ends at the start, d
  double dt_ = 0.0;
  std::int64_t n_steps_ = 0, steps_done_ = 0;
};

} // namespace boba
