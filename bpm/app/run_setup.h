// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/caller_observer.h"
#include "bpm/app/output_folder.h"
#include "bpm/dynamics/simulation.h"
#include "bpm/io/folder_lock.h"
#include "bpm/scene/scene.h"
#include "bpm/scene/scene_stages.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// Everything a run needs, decided and checked, before its folder is made.
struct RunSetup {
  Scene scene;
  OutputFolder folder;
  Packing packing;
  std::vector<PreparedStage> stages;
  std::optional<double> modulus; ///< E / (2 - 2 nu^2) of the packing, k/d
  bool quiet = false;

  /// Set when the run goes on from a checkpoint.
  struct Restart {
    SavedState state;      ///< the whole checkpoint
    std::int64_t step = 0; ///< of the simulation
    std::string file;
  };
  std::optional<Restart> restart;

  /// Files that are missing are begun without what they held: the user accepts the gaps.
  bool accept_gaps = false;
  std::vector<std::string> gaps; ///< what is missing, in words

  std::chrono::steady_clock::time_point begin; ///< of the command: the wall-time limit counts from here
  std::shared_ptr<const FolderLock> lock;      ///< of the folder; on rank 0
  std::optional<CallerPipes> caller;           ///< the program that started this one and looks at the run
};

} // namespace boba
