// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/deform_entry.h"
#include "bpm/stages/rest_search.h"

namespace boba {

/// Strains one component of the cell in steps, each followed by a search for rest.
struct QuasistaticStage {
  RestPlan rest;     ///< max_time is that of one search
  DeformStage cell;  ///< along a strain; its time is of no use
  int component = 3; ///< that is strained
  std::int64_t steps = 1;
};

/// The limit of small rates: stress and modulus as functions of the strain.
class QuasistaticDriver : public StageDriver {
public:
  explicit QuasistaticDriver(const QuasistaticStage& stage);

  std::string name() const override { return "quasistatic"; }
  void begin(Stepper& stepper) override;
  bool needs_pressure() const override { return true; }
  bool needs_stress() const override { return true; }
  CellRates update(Stepper& stepper) override;
  bool finished() const override { return is_over_; }
  std::int64_t steps_left(const Stepper&) const override { return is_over_ ? 0 : -1; }
  bool may_end(const Stepper&) const override { return rest_.is_checking(); }
  double shear_rate() const override { return moves_next_ ? cell_.shear_rate() : 0.0; }
  void end(Stepper&) override {}
  StageProgress progress(const Stepper& stepper) const override;
  std::string report() const override;
  const StageTable* table() const override { return &table_; }
  void archive(Archive& archive) override;

private:
  void note_rest(const Stepper& stepper);

  QuasistaticStage stage_;
  RestSearch rest_;
  DeformDriver cell_;
  StageTable table_;
  std::int64_t steps_done_ = 0;
  bool moves_next_ = false, is_over_ = false;
};

/// A [[stage]] with `type = "quasistatic"`.
class QuasistaticEntry : public StageEntry {
public:
  static SceneSection section();
  explicit QuasistaticEntry(const SceneTable& table);

  void check(const SceneTable& table, const StageSurroundings& surroundings) const override;
  bool moves_cell() const override { return true; }
  bool holds_pressure() const override { return false; }
  bool has_ends() const override { return false; }
  bool shows_stress() const override { return true; }
  bool has_table() const override { return true; }
  StageLength estimate(const StageContext& context) const override;
  std::unique_ptr<StageDriver> make_driver(const StageContext& context) const override;

private:
  QuasistaticStage stage_;
};

} // namespace boba
