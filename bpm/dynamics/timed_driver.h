// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stage_driver.h"

namespace boba {

/// A stage of a known number of steps: simple shear for a strain, or a hold (shear at rate 0) for a time; with or
/// without a barostat.
class TimedDriver : public StageDriver {
public:
  explicit TimedDriver(const ShearStage& stage) : shear_(stage), is_shear_(true) {}
  explicit TimedDriver(const HoldStage& stage);

  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return shear_.barostat.has_value(); }
  CellRates update(Stepper& stepper) override;
  bool finished() const override { return steps_done_ >= n_steps_; }
  std::int64_t steps_left(const Stepper&) const override { return n_steps_ - steps_done_; }
  void end(Stepper& stepper) override;
  StageProgress progress(const Stepper& stepper) const override;
  void save(SavedState& saved) const override;
  void restore(const SavedState& saved, Stepper& stepper) override;

private:
  ShearStage shear_;
  bool is_shear_ = false;
  double hold_time_ = 0.0;
  std::int64_t n_steps_ = 0, steps_done_ = 0;
  double gain_ = 0.0;
};

} // namespace boba
