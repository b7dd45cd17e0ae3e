// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stage_driver.h"
#include "bpm/stages/held_pressure.h"
#include "bpm/stages/pressure_keys.h"
#include "bpm/stages/timed_steps.h"

namespace boba {

/// A fixed cell, or a constant pressure, for a time.
struct HoldStage {
  double time = 0.0; ///< tau
  std::optional<Barostat> barostat;
};

class HoldDriver : public StageDriver {
public:
  explicit HoldDriver(const HoldStage& stage) : stage_(stage), pressure_(stage.barostat) {}

  std::string name() const override { return "hold"; }
  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return pressure_.is_held(); }
  CellRates update(Stepper& stepper) override;
  bool finished() const override { return steps_.finished(); }
  std::int64_t steps_left(const Stepper&) const override { return steps_.left(); }
  bool may_end(const Stepper&) const override { return steps_.left() == 1; }
  double shear_rate() const override { return 0.0; }
  void end(Stepper&) override {}
  StageProgress progress(const Stepper& stepper) const override;
  std::string report() const override { return pressure_.is_held() ? pressure_.report().text() : ""; }
  bool has_missed() const override { return pressure_.has_missed(); }
  void archive(Archive& archive) override;

private:
  HoldStage stage_;
  TimedSteps steps_;
  HeldPressure pressure_;
};

/// A [[stage]] with `type = "hold"`.
class HoldEntry : public StageEntry {
public:
  static SceneSection section();
  explicit HoldEntry(const SceneTable& table);

  void check(const SceneTable& table, const StageSurroundings& surroundings) const override;
  bool moves_cell() const override { return pressure_.is_given(); }
  bool holds_pressure() const override { return pressure_.is_given(); }
  bool has_ends() const override { return false; }
  StageLength estimate(const StageContext& context) const override;
  std::unique_ptr<StageDriver> make_driver(const StageContext& context) const override;
  /// As the scene gives them, but for the pressure.
  const HoldStage& parameters() const { return parameters_; }
  const ScenePressure& pressure() const { return pressure_; }

private:
  HoldStage parameters_;
  ScenePressure pressure_;
};

} // namespace boba
