// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stage_driver.h"

namespace boba {

/// Isotropic compression: a ramp at a constant rate to the target pressure, then the barostat until pressure and
/// kinetic energy have settled.
class CompressDriver : public StageDriver {
public:
  explicit CompressDriver(const CompressStage& stage) : stage_(stage) {}

  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return true; }
  CellRates update(Stepper& stepper) override;
  bool finished() const override { return phase_ == Phase::settled; }
  std::int64_t steps_left(const Stepper&) const override { return -1; }
  bool may_end(const Stepper& stepper) const override;
  StageProgress progress(const Stepper& stepper) const override;
  void save(SavedState& saved) const override;
  void restore(const SavedState& saved, Stepper& stepper) override;

private:
  enum class Phase { ramp, settle, settled };
  bool has_settled(const Stepper& stepper) const;
  double bulk_modulus(Stepper& stepper) const;

  /// A moment of the ramp.
  struct Halfway {
    double time = -1.0;    ///< tau, negative before it came
    double pressure = 0.0; ///< k/d
  };
  CompressStage stage_;
  Phase phase_ = Phase::ramp;
  double start_time_ = 0.0;
  double gain_ = 0.0;
  Halfway halfway_; ///< when the ramp passed half of the target pressure
};

} // namespace boba
