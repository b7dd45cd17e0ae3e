// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/measure/measure_run.h"
#include "bpm/io/trajectory.h"

#include <filesystem>

namespace boba {

std::filesystem::path trajectory_of(const std::filesystem::path& run);
std::filesystem::path folder_of(const MeasureRunOptions& options);

// All that can be wrong with a call of `boba measure` is found before anything is written.

/// Numbers of the command line, and whether there is a trajectory. \throws InputError
void check_measure_options(const MeasureRunOptions& options);

/// Whether the trajectory has what is asked for: frames, strains inside the window, grains with hulls. \throws
/// InputError
void check_measure_frames(const MeasureRunOptions& options, const TrajectoryReader& reader);

/// Whether the tables may be written: they are not there, or are tables of such measures and `force` is given, and no
/// run that goes on writes them itself. \throws InputError
void check_measure_folder(const MeasureRunOptions& options);

} // namespace boba
