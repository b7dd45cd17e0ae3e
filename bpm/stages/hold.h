// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/pressure_keys.h"
#include "bpm/stages/stage.h"
#include "bpm/stages/timed_pressure_driver.h"

namespace boba {

/// A fixed cell, or a constant pressure, for a time.
struct HoldStage {
  double time = 0.0; ///< tau
  std::optional<Barostat> barostat;
};

class HoldDriver : public TimedPressureDriver {
public:
  explicit HoldDriver(const HoldStage& stage) : TimedPressureDriver(stage.barostat), stage_(stage) {}

  std::string name() const override { return "hold"; }
  void begin(Stepper& stepper) override;
  CellRates update(Stepper& stepper) override;
  double shear_rate() const override { return 0.0; }
  StageProgress progress(const Stepper& stepper) const override;

private:
  HoldStage stage_;
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
