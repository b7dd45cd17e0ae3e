// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/stage.h"
#include "bpm/stages/timed_driver.h"

namespace boba {

/// Squeezes a specimen or a packing along z between two rigid walls or two clamped ends (which move towards each other
/// with `velocity` each, symmetrically), until the nominal strain is reached. Walls that stand already move on from
/// where they are.
struct PressStage {
  enum class Ends { walls, clamps };
  Ends ends = Ends::walls;
  double velocity = 1e-3;       ///< of each end, d/tau; negative pulls (clamps), or moves the walls back
  double strain = 0.0;          ///< nominal strain: displacement of both ends together over their distance at the start
  double clamp_thickness = 2.0; ///< d; nodes within this distance of the specimen's ends move rigidly
};

/// Squeezes (or, with clamps, pulls) a specimen along z between two walls or two clamped ends.
class PressDriver : public TimedDriver {
public:
  explicit PressDriver(const PressStage& stage) : stage_(stage) {}

  std::string name() const override { return "press"; }
  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return false; }
  CellRates update(Stepper& stepper) override;
  double shear_rate() const override { return 0.0; }
  void end(Stepper& stepper) override;
  StageProgress progress(const Stepper& stepper) const override;
  void archive(Archive& archive) override;

private:
  void begin_walls(Stepper& stepper);
  void begin_clamps(Stepper& stepper);
  double moved() const; ///< by each end so far, d

  PressStage stage_;
  double height_ = 0.0; ///< between the ends at the start, d
  double dt_ = 0.0;
};

/// A [[stage]] with `type = "press"`.
class PressEntry : public StageEntry {
public:
  static SceneSection section();
  explicit PressEntry(const SceneTable& table);

  void check(const SceneTable& table, const StageSurroundings& surroundings) const override;
  bool moves_cell() const override { return false; }
  bool holds_pressure() const override { return false; }
  bool has_ends() const override { return true; }
  StageLength estimate(const StageContext& context) const override;
  std::unique_ptr<StageDriver> make_driver(const StageContext& context) const override;
  /// As the scene gives them.
  const PressStage& parameters() const { return parameters_; }

private:
  PressStage parameters_;
};

} // namespace boba
