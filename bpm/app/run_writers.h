// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/frame_observer.h"
#include "bpm/app/measure/measure_tables.h"
#include "bpm/app/run_setup.h"
#include "bpm/app/table_observer.h"
#include "bpm/app/write_behind.h"
#include "bpm/io/shared_trajectory.h"

#include <memory>
#include <vector>

namespace boba {

/// The files a scene asks for, as observers. New ones for a new run; a run that goes on cuts them at its checkpoint.
struct RunWriters {
  std::unique_ptr<TableObserver> table;
  std::vector<std::unique_ptr<WriteBehind>> behind;   ///< what writes dump and VTK; on rank 0
  std::vector<std::unique_ptr<FrameObserver>> frames; ///< trajectory, dump, VTK, measures

  /// On all ranks. Closed at the end of a run, where a failure is still told; null when not asked for.
  std::shared_ptr<SharedTrajectory> trajectory;
  /// The measures of motion, which look back to the frame before; null when not asked for.
  std::shared_ptr<MeasureTables> motion;

  /// Returns when all frames handed out are in their files. \throws std::runtime_error when one could not be written.
  void wait() const;
  /// What the writers have written so far: below the name of each.
  void archive(Archive& archive);
};

/// The simulation is in the state that the run starts from. All ranks write the trajectory and take measures; all other
/// files, tables of measures among them, are rank 0's, and the others look when it looks.
/// \throws std::runtime_error when a file cannot be made or does not belong to the checkpoint.
RunWriters open_writers(const RunSetup& setup, const Simulation& simulation, const PackingNumbers& numbers);

} // namespace boba
