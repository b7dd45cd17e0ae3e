// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/pressure_keys.h"
#include "bpm/stages/stage.h"
#include "bpm/stages/timed_pressure_driver.h"

namespace boba {

/// Simple shear, of itself in x with gradient y, at constant volume or at a held pressure.
struct ShearStage {
  double rate = 0.0;   ///< 1/tau; negative shears backwards
  double strain = 0.0; ///< > 0, to be added by this stage
  Remap remap = Remap::positions;
  std::optional<Barostat> barostat;
};

class ShearDriver : public TimedPressureDriver {
public:
  explicit ShearDriver(const ShearStage& stage) : TimedPressureDriver(stage.barostat), stage_(stage) {}

  std::string name() const override { return "shear"; }
  void begin(Stepper& stepper) override;
  CellRates update(Stepper& stepper) override;
  double shear_rate() const override { return stage_.rate; }
  StageProgress progress(const Stepper& stepper) const override;

private:
  ShearStage stage_;
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
