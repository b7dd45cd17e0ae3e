// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stage_driver.h"
#include "bpm/stages/held_pressure.h"
#include "bpm/stages/pressure_keys.h"
#include "bpm/stages/timed_steps.h"

namespace boba {

/// Simple shear, of itself in x with gradient y, at constant volume or at a held pressure.
struct ShearStage {
  double rate = 0.0;   ///< 1/tau; negative shears backwards
  double strain = 0.0; ///< > 0, to be added by this stage
  Remap remap = Remap::positions;
  std::optional<Barostat> barostat;
};

class ShearDriver : public StageDriver {
public:
  explicit ShearDriver(const ShearStage& stage) : stage_(stage), pressure_(stage.barostat) {}

  std::string name() const override { return "shear"; }
  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return pressure_.is_held(); }
  CellRates update(Stepper& stepper) override;
  bool finished() const override { return steps_.finished(); }
  std::int64_t steps_left(const Stepper&) const override { return steps_.left(); }
  bool may_end(const Stepper&) const override { return steps_.left() == 1; }
  double shear_rate() const override { return stage_.rate; }
  void end(Stepper&) override {}
  StageProgress progress(const Stepper& stepper) const override;
  std::string report() const override { return pressure_.is_held() ? pressure_.report().text() : ""; }
  bool has_missed() const override { return pressure_.has_missed(); }
  void archive(Archive& archive) override;

private:
  ShearStage stage_;
  TimedSteps steps_;
  HeldPressure pressure_;
};

/// A [[stage]] with `type = "shear"`.
class ShearEntry : public StageEntry {
public:
  static SceneSection section();
  explicit ShearEntry(const SceneTable& table);

  void check(const SceneTable& table, const StageSurroundings& surroundings) const override;
  bool moves_cell() const override { return true; }
  bool holds_pressure() const override { return pressure_.is_given(); }
  bool has_ends() const override { return false; }
  StageLength estimate(const StageContext& context) const override;
  std::unique_ptr<StageDriver> make_driver(const StageContext& context) const override;
  /// As the scene gives them, but for the pressure.
  const ShearStage& parameters() const { return parameters_; }
  const ScenePressure& pressure() const { return pressure_; }

  bool shows_stress() const override { return !is_plain(); }

private:
  /// In xy and without a held normal stress: ShearDriver does it, anything else is a deformation of the cell.
  bool is_plain() const { return plane_ == 3 && !holds_normal_stress_; }

  ShearStage parameters_;
  ScenePressure pressure_;
  int plane_ = 3; ///< component of the cell
  bool holds_normal_stress_ = false;
};

} // namespace boba
