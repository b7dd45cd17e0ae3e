// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stage_driver.h"
#include "bpm/laws/material.h"
#include "bpm/packing/packing_numbers.h"
#include "bpm/toml/scene_table.h"

#include <memory>
#include <string>

namespace boba {

/// What a scene says beyond the stage's own table, when the stage is checked.
struct StageSurroundings {
  bool cell_is_open = false; ///< a specimen's cell; that of a packing is periodic
  double dt = 0.1;           ///< tau
  Material material;
};

/// What is known of the packing when a stage is prepared; not to be kept beyond the call.
struct StageContext {
  std::string scene;      ///< path, for messages
  const Packing& packing; ///< as the run starts; with several ranks only rank 0 has its nodes
  PackingNumbers numbers;
};

struct StageLength {
  double time = 0.0;    ///< tau
  bool is_exact = true; ///< otherwise a guess
};

/// A [[stage]] of a scene: what everybody but the time loop wants to know of it. One class per kind of stage, in the
/// file that also holds its driver.
///
/// Beside these members a class has `static SceneSection section()`, its keys, and a constructor that reads a table
/// which has been checked against them; register_stage takes the class. See examples/extend.
class StageEntry {
public:
  virtual ~StageEntry() = default;
  /// Refuses what no single key can be blamed for: a cell that the stage has no use for, a stage that would never end.
  /// \throws InputError by SceneTable::fail.
  virtual void check(const SceneTable& table, const StageSurroundings& surroundings) const = 0;
  virtual bool moves_cell() const = 0;
  virtual bool holds_pressure() const = 0;
  /// Does it put up walls or clamps? They stay where they are for the stages that follow, and frames do not hold them.
  virtual bool has_ends() const = 0;
  /// Does the run's table have all components of the stress? They are shown when one stage of the scene wants them.
  virtual bool shows_stress() const { return false; }
  /// Does its driver have a table of its own (StageDriver::table)?
  virtual bool has_table() const { return false; }
  /// For `boba check`, before anything runs.
  virtual StageLength estimate(const StageContext& context) const = 0;
  /// \throws InputError when a pressure that is given relative to E / (2 - 2 nu^2) cannot be known.
  virtual std::unique_ptr<StageDriver> make_driver(const StageContext& context) const = 0;
};

/// Refuses an open cell, or a periodic one: for `check`.
void require_periodic_cell(const SceneTable& table, const StageSurroundings& surroundings);
void require_open_cell(const SceneTable& table, const StageSurroundings& surroundings);
/// Refuses a stage of more steps than can be counted; `key` is what makes it last `duration` (tau).
void require_countable_steps(const SceneTable& table, const std::string& key, double duration, double dt);

} // namespace boba
