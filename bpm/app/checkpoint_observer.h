// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/run_setup.h"
#include "bpm/app/run_writers.h"
#include "bpm/app/schedule.h"
#include "bpm/archive/archive.h"
#include "bpm/dynamics/observer.h"
#include "bpm/io/checkpoint.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// What a run is, for its checkpoints: below "run". Source: docs/formats.md, "Checkpoint".
struct RunRecord {
  std::string scene, scene_path;
  std::vector<std::string> overrides; ///< of the command line
  std::string version, instruction_set;
  std::optional<double> modulus; ///< E / (2 - 2 nu^2), k/d

  void archive(Archive& archive);
};

/// What a checkpoint holds beyond the simulation's state, so that a run can continue from it alone: its record, and the
/// packing's grains and networks.
SavedState constant_part(const RunSetup& setup, const Simulation& simulation);

/// The record of the run that a checkpoint belongs to. \throws InputError when it lacks a part.
RunRecord run_record(const LatestCheckpoint& checkpoint);

/// Rank 0's checkpoint for all, but for what belongs to single nodes: Simulation::restore hands that out.
void share_checkpoint(LatestCheckpoint& checkpoint, const Ranks& ranks);

/// The inverse of constant_part: a setup that goes on from the checkpoint. Paths of the scene need not exist any more.
/// \throws InputError when the checkpoint lacks a part.
RunSetup setup_from(const LatestCheckpoint& checkpoint, const OutputFolder& folder);

/// Adds what the writers have written so far: the part of RunSetup::Restart that is theirs.
void store_writers(SavedState& data, RunWriters& writers);

/// Writes checkpoints by real time and by simulated time.
class CheckpointObserver : public Observer {
public:
  /// `store_writers` adds what the other writers have written, see RunSetup::Restart.
  CheckpointObserver(std::filesystem::path folder, SavedState constant, double every_seconds, const Schedule& schedule,
                     std::function<void(SavedState&)> store_writers)
      : folder_(std::move(folder)), data_(std::move(constant)), every_seconds_(every_seconds), schedule_(schedule),
        store_writers_(std::move(store_writers)) {}

  bool wants(const StepForecast& forecast) override;
  void observe(const Simulation& simulation, const StageProgress& progress) override;
  /// Writes one now and returns its path, on rank 0. Collective.
  std::filesystem::path write(const Simulation& simulation);

private:
  std::filesystem::path folder_;
  SavedState data_;
  double every_seconds_;
  Schedule schedule_;
  std::function<void(SavedState&)> store_writers_;
  bool due_ = false;
  double now_ = 0.0, last_ = 0.0; ///< s, by the forecasts
};

} // namespace boba
