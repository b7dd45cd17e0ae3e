// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/run_setup.h"
#include "bpm/app/run_writers.h"
#include "bpm/app/schedule.h"
#include "bpm/dynamics/observer.h"
#include "bpm/io/checkpoint.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace boba {

/// What a checkpoint holds beyond the simulation's state, so that a run can go on from it alone: the scene's text and
/// overrides, the packing's grains and networks, the modulus, the instruction set. Source: docs/formats.md,
/// "Checkpoint".
CheckpointData constant_part(const RunSetup& setup, const Simulation& simulation);

/// Rank 0's checkpoint for all, but for what belongs to single nodes: Simulation::restore hands that out.
void share_checkpoint(LatestCheckpoint& checkpoint, const Ranks& ranks);

/// The inverse of constant_part: a setup that goes on from the checkpoint. Paths of the scene need not exist any more.
/// \throws InputError when the checkpoint lacks a part.
RunSetup setup_from(const LatestCheckpoint& checkpoint, const OutputFolder& folder);

/// Adds what the writers have written so far: the part of RunSetup::Restart that is theirs.
void store_writers(CheckpointData& data, const RunWriters& writers);

/// Writes checkpoints by real time and by simulated time.
class CheckpointObserver : public Observer {
public:
  /// `store_writers` adds what the other writers have written, see RunSetup::Restart.
  CheckpointObserver(std::filesystem::path folder, CheckpointData constant, double every_seconds,
                     const Schedule& schedule, std::function<void(CheckpointData&)> store_writers)
      : folder_(std::move(folder)), data_(std::move(constant)), every_seconds_(every_seconds), schedule_(schedule),
        store_writers_(std::move(store_writers)) {}

  bool wants(const StepForecast& forecast) override;
  void observe(const Simulation& simulation, const StageProgress& progress) override;
  /// Writes one now and returns its path, on rank 0. Collective.
  std::filesystem::path write(const Simulation& simulation);

private:
  std::filesystem::path folder_;
  CheckpointData data_;
  double every_seconds_;
  Schedule schedule_;
  std::function<void(CheckpointData&)> store_writers_;
  bool due_ = false;
  double now_ = 0.0, last_ = 0.0; ///< s, by the forecasts
};

} // namespace boba
