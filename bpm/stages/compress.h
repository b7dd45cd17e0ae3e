// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/barostat.h"
#include "bpm/dynamics/stage_driver.h"
#include "bpm/stages/pressure_keys.h"

namespace boba {

/// Isotropic compression at a constant rate until the pressure is reached, then a hold under the barostat until
/// |P / P_target - 1| < pressure_tolerance and kinetic / elastic energy < kinetic_tolerance.
struct CompressStage {
  Barostat barostat;
  double rate = 5e-4; ///< -d ln L / dt of the ramp, 1/tau
  double pressure_tolerance = 1e-3;
  double kinetic_tolerance = 1e-4;
  double max_time = 1e6; ///< tau; the stage fails when it has not settled by then
};

/// Isotropic compression: a ramp at a constant rate to the target pressure, then the barostat until pressure and
/// kinetic energy have settled.
class CompressDriver : public StageDriver {
public:
  explicit CompressDriver(const CompressStage& stage) : stage_(stage) {}

  std::string name() const override { return "compress"; }
  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return true; }
  CellRates update(Stepper& stepper) override;
  bool finished() const override { return phase_ == Phase::settled; }
  std::int64_t steps_left(const Stepper&) const override { return -1; }
  bool may_end(const Stepper& stepper) const override;
  double shear_rate() const override { return 0.0; }
  void end(Stepper&) override {}
  StageProgress progress(const Stepper& stepper) const override;
  void archive(Archive& archive) override;

private:
  enum class Phase { ramp, settle, settled };
  bool has_settled(const Stepper& stepper) const;
  double bulk_modulus(Stepper& stepper) const;

  /// Where the ramp stood when it passed half of the target pressure.
  struct Halfway {
    double time = -1.0;    ///< tau; negative before that
    double pressure = 0.0; ///< k/d
  };
  CompressStage stage_;
  Phase phase_ = Phase::ramp;
  double start_time_ = 0.0;
  double gain_ = 0.0;
  Halfway halfway_;
};

/// A [[stage]] with `type = "compress"`.
class CompressEntry : public StageEntry {
public:
  static SceneSection section();
  explicit CompressEntry(const SceneTable& table);

  void check(const SceneTable& table, const StageSurroundings& surroundings) const override;
  bool moves_cell() const override { return true; }
  bool holds_pressure() const override { return true; }
  bool has_ends() const override { return false; }
  StageLength estimate(const StageContext& context) const override;
  std::unique_ptr<StageDriver> make_driver(const StageContext& context) const override;
  /// As the scene gives them, but for the pressure.
  const CompressStage& parameters() const { return parameters_; }
  const ScenePressure& pressure() const { return pressure_; }

private:
  CompressStage parameters_;
  ScenePressure pressure_;
};

} // namespace boba
