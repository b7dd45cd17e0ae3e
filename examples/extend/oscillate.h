// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bpm/stages/stage_registry.h>
#include <bpm/stages/timed_driver.h>

/// Shears the cell to and fro at constant volume: strain = amplitude sin(2 pi t / period), for whole cycles.
struct Oscillation {
  double amplitude = 0.0; ///< strain
  double period = 0.0;    ///< tau
  std::int64_t cycles = 1;
};

/// What the stage does around each step.
class OscillateDriver : public boba::TimedDriver {
public:
  explicit OscillateDriver(const Oscillation& stage) : stage_(stage) {}

  std::string name() const override { return "oscillate"; }
  void begin(boba::Stepper& stepper) override;
  bool needs_pressure() const override { return false; }
  boba::CellRates update(boba::Stepper& stepper) override;
  double shear_rate() const override;
  boba::StageProgress progress(const boba::Stepper& stepper) const override;
  void archive(boba::Archive& archive) override;

private:
  double strain_after(std::int64_t steps) const;

  Oscillation stage_;
  double dt_ = 0.0; ///< tau
};

/// The stage as a scene gives it: [[stage]] with `type = "oscillate"`.
class OscillateEntry : public boba::StageEntry {
public:
  static boba::SceneSection section();
  explicit OscillateEntry(const boba::SceneTable& table);

  void check(const boba::SceneTable& table, const boba::StageSurroundings& surroundings) const override;
  bool moves_cell() const override { return true; }
  bool holds_pressure() const override { return false; }
  bool has_ends() const override { return false; }
  boba::StageLength estimate(const boba::StageContext& context) const override;
  std::unique_ptr<boba::StageDriver> make_driver(const boba::StageContext& context) const override;

private:
  Oscillation stage_;
};
