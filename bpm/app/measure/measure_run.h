// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/measure_plan.h"
#include "bpm/parallel/ranks.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace boba {

/// What `boba measure` was asked to do.
struct MeasureRunOptions {
  std::filesystem::path run;    ///< output folder of a run, or a trajectory file
  std::filesystem::path output; ///< folder of the tables; empty: `measures` in the run's folder
  MeasurePlan plan;
  std::int64_t every = 1;                      ///< every so many frames, from the first
  std::optional<double> every_strain;          ///< instead: a frame whenever the strain has changed by this much
  std::optional<std::int64_t> only_frame;      ///< this frame alone; negative counts from the end
  std::optional<std::array<double, 2>> window; ///< strain window of averages.json; all frames without it
  bool force = false;                          ///< replace tables that are there
  bool stored_stress = false;                  ///< take the stress that the run stored, evaluate nothing
  int threads = 0;                             ///< of a rank; 0: all cores, or a rank's share of them
};

struct MeasureRunResult {
  std::int64_t n_frames = 0;
  std::filesystem::path folder;
  bool undeformed_known = true; ///< false: no frame shows the undeformed grains, so the baseline columns are empty
  bool velocity_known = true;   ///< false: no velocities are stored
  std::string stored_stress;    ///< why the stress is the stored one; empty: the forces were evaluated again
  std::string averages;         ///< lines for the terminal: quantity, mean, standard error
};

/// Measures the stored frames of a finished or running run. Collective: every rank reads the frames, they are measured
/// together, and rank 0 writes.
/// \throws InputError for a run that cannot be read or a frame that is not there; std::runtime_error when tables exist
/// (without `force`) or cannot be written. RankError on all when there are several ranks.
MeasureRunResult measure_run(const MeasureRunOptions& options, const Ranks& ranks = Ranks::alone());

} // namespace boba
