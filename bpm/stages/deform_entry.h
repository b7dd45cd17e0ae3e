// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/deform.h"
#include "bpm/stages/pressure_keys.h"

#include <memory>

namespace boba {

/// A [[stage]] that deforms the cell: what all its kinds have in common. Stresses and pressures of `stage_` are as the
/// scene gives them, and multiples of E / (2 - 2 nu^2) where it says so.
class LoadingEntry : public StageEntry {
public:
  void check(const SceneTable& table, const StageSurroundings& surroundings) const override;
  bool moves_cell() const override { return true; }
  bool holds_pressure() const override { return stage_.pressure.has_value(); }
  bool has_ends() const override { return false; }
  bool shows_stress() const override { return true; }
  bool has_table() const override;
  StageLength estimate(const StageContext& context) const override;
  std::unique_ptr<StageDriver> make_driver(const StageContext& context) const override;
  /// As the scene gives them.
  const DeformStage& parameters() const { return stage_; }

protected:
  explicit LoadingEntry(const SceneTable& table);
  /// \throws InputError when the stage drives nothing, or its length is not given.
  void set_time(const SceneTable& table, double time);

  DeformStage stage_;
  bool normalised_ = false; ///< stresses are multiples of E / (2 - 2 nu^2)

private:
  std::string table_; ///< name, for messages
};

/// A [[stage]] with `type = "deform"`.
class DeformEntry : public LoadingEntry {
public:
  static SceneSection section();
  explicit DeformEntry(const SceneTable& table);

private:
  void read_component(const SceneTable& table, int component);
  double read_time(const SceneTable& table) const;
  void check_rates(const SceneTable& table) const;
};

/// Keys of loadings: what strains mean; stresses relative to the grains' modulus; gain and cap of the servos.
SceneKey measure_key();
SceneKey normalised_key();
std::vector<SceneKey> servo_keys();

} // namespace boba
