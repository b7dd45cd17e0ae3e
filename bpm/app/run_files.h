// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/output_folder.h"
#include "bpm/scene/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace boba {

/// The names of the files that a run of this scene writes into its folder; "*" stands for a number. They are listed in
/// files.txt before the first of them is made, so that `--force` later knows them from what others put there.
std::vector<std::string> files_of_run(const Scene& scene);

/// What files_of_run calls the tables of stages.
inline constexpr const char* stage_tables_name = "stages/stage-*.csv";

/// Writes the list of a new run. \throws std::runtime_error
void write_file_list(const OutputFolder& folder, const std::vector<std::string>& names);

/// The same for `boba measure` in the run's own folder of measures.
std::vector<std::string> files_of_measures(const MeasurePlan& plan);

/// Adds names that are not in the list yet; does nothing in a folder without one. \throws std::runtime_error
void add_to_file_list(const OutputFolder& folder, const std::vector<std::string>& names);

/// The files that are there and that earlier runs, or measures of them, wrote. Names that no run has are left out,
/// whatever the list says; without a list (runs up to version 0.1) all names that a run may have are taken for its own.
std::vector<std::filesystem::path> files_written_in(const OutputFolder& folder);

/// Something a run wrote is there: its list of files, or a scene with a checkpoint.
bool holds_run(const OutputFolder& folder);

/// The scene and the files that it names in [start].
std::vector<std::filesystem::path> files_read_by(const Scene& scene);

/// Whether a run of this scene may write into the folder, which may already hold things. Nothing is changed.
///
/// Without `force` the folder must be missing or empty. With it, it must hold a run; neither a file that the scene
/// reads may be among those that would be removed, nor may a file that no run wrote stand where the new one writes.
/// \throws InputError
void check_free(const OutputFolder& folder, const Scene& scene, bool force);

/// Removes what runs wrote, but for scene.toml and files.txt, which are replaced later; folders when nothing else is in
/// them.
/// \throws std::runtime_error
void remove_written(const OutputFolder& folder);

} // namespace boba
