// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/deform_entry.h"
#include "bpm/stages/rest_search.h"

namespace boba {

/// Brings a packing to rest in a fixed cell, or in one whose components hold stresses or a pressure.
struct RelaxStage {
  RestPlan rest;
  DeformStage cell;               ///< its stresses and pressure alone
  double stress_tolerance = 1e-4; ///< of |sigma - target| over |target|, or over the largest stress for a target of 0
};

class RelaxDriver : public StageDriver {
public:
  explicit RelaxDriver(const RelaxStage& stage);

  std::string name() const override { return "relax"; }
  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return true; }
  bool needs_stress() const override { return true; } // and the forces, which are kept with it
  CellRates update(Stepper& stepper) override;
  bool finished() const override { return is_at_rest_; }
  std::int64_t steps_left(const Stepper&) const override { return is_at_rest_ ? 0 : -1; }
  bool may_end(const Stepper&) const override { return rest_.is_checking(); }
  double shear_rate() const override { return 0.0; }
  void end(Stepper&) override {}
  StageProgress progress(const Stepper& stepper) const override;
  std::string report() const override;
  void archive(Archive& archive) override;

private:
  bool stresses_hold(const Stepper& stepper) const;

  RelaxStage stage_;
  RestSearch rest_;
  DeformDriver cell_;
  bool moves_cell_ = false;
  bool is_at_rest_ = false;
  std::int64_t first_step_ = 0, last_step_ = 0;
};

/// A [[stage]] with `type = "relax"`.
class RelaxEntry : public StageEntry {
public:
  static SceneSection section();
  explicit RelaxEntry(const SceneTable& table);

  void check(const SceneTable& table, const StageSurroundings& surroundings) const override;
  bool moves_cell() const override { return moves_cell_; }
  bool holds_pressure() const override { return moves_cell_; }
  bool has_ends() const override { return false; }
  bool shows_stress() const override { return true; }
  StageLength estimate(const StageContext& context) const override;
  std::unique_ptr<StageDriver> make_driver(const StageContext& context) const override;

private:
  RelaxStage stage_;
  ScenePressure pressure_;
  bool moves_cell_ = false;
};

} // namespace boba
