// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/run_files.h"

#include "bpm/app/measure/measure_tables.h"
#include "bpm/io/input_error.h"
#include "bpm/io/output_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <set>
#include <stdexcept>

namespace boba {

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> always_written = {"files.txt",
                                                 "scene.toml",
                                                 "run.log",
                                                 "table.csv",
                                                 "checkpoints/checkpoint-*.boba",
                                                 "checkpoints/checkpoint-*.boba.part"};
const std::vector<std::string> vtk_names = {"vtk/packing.pvd", "vtk/packing.pvd.part", "vtk/packing_*.vtp"};
constexpr const char* averages_name = "measures/averages.json";

template <class Value> void append(std::vector<Value>& names, const std::vector<Value>& more) {
  names.insert(names.end(), more.begin(), more.end());
}

std::vector<std::string> measure_names_of(const MeasurePlan& plan) {
  std::vector<std::string> names;
  for (const MeasureTable& table : MeasureTables::tables_of(plan)) {
    names.push_back("measures/" + table.name + ".csv");
  }
  return names;
}

/// Every name that a run, or a measure of it, can have.
std::set<std::string> names_of_any_run() {
  std::vector<std::string> names = always_written;
  append<std::string>(names, {"trajectory.h5", "dump.lammpstrj", averages_name, stage_tables_name});
  append(names, vtk_names);
  MeasurePlan all_kinds;
  choose_measures(all_kinds, {"all"});
  all_kinds.facet_sensitivity = true;
  append(names, measure_names_of(all_kinds));
  return {names.begin(), names.end()};
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(fs::symlink_status(path, error));
}

bool is_number_between(const std::string& name, const std::string& begin, const std::string& end) {
  return name.size() > begin.size() + end.size() && name.starts_with(begin) && name.ends_with(end) &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(begin.size()),
                     name.end() - static_cast<std::ptrdiff_t>(end.size()), [](char c) { return c >= '0' && c <= '9'; });
}

/// The files of the folder that a name stands for.
void add_files_of(const fs::path& root, const std::string& name, std::vector<fs::path>& found) {
  const std::size_t star = name.find('*');
  if (star == std::string::npos) {
    if (is_there(root / name)) {
      found.push_back(root / name);
    }
    return;
  }
  const std::size_t slash = name.find('/');
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root / name.substr(0, slash), error)) {
    if (is_number_between(entry.path().filename().string(), name.substr(slash + 1, star - slash - 1),
                          name.substr(star + 1))) {
      found.push_back(entry.path());
    }
  }
}

std::vector<fs::path> files_named(const OutputFolder& folder, const std::vector<std::string>& names) {
  std::vector<fs::path> found;
  for (const std::string& name : names) {
    add_files_of(folder.root(), name, found);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// What files.txt lists, of the names that a run can have.
std::set<std::string> names_in_list(const OutputFolder& folder) {
  const std::set<std::string> known = names_of_any_run();
  std::set<std::string> names;
  std::ifstream in(folder.file_list());
  for (std::string line; std::getline(in, line);) {
    if (known.contains(line)) {
      names.insert(line);
    }
  }
  return names;
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  return fs::equivalent(a, b, error) && !error;
}

void check_room_for(const OutputFolder& folder, const Scene& scene) {
  const std::vector<fs::path> own = files_written_in(folder);
  for (const fs::path& file : own) {
    for (const fs::path& read : files_read_by(scene)) {
      if (file != folder.scene() && same_file(file, read)) {
        throw InputError(fmt::format("output: {} belongs to the run that --force would replace, and {} reads it; "
                                     "--output names another folder",
                                     file.string(), scene.path.string()));
      }
    }
  }
  for (const fs::path& file : files_named(folder, files_of_run(scene))) {
    if (!std::binary_search(own.begin(), own.end(), file)) {
      throw InputError(fmt::format("output: {} stands where the run would write, and no run wrote it; --force removes "
                                   "only what a run wrote, --output names another folder",
                                   file.string()));
    }
  }
}

} // namespace

std::vector<std::string> files_of_run(const Scene& scene) {
  std::vector<std::string> names = always_written;
  if (scene.output.trajectory) {
    names.emplace_back("trajectory.h5");
  }
  if (scene.output.dump) {
    names.emplace_back("dump.lammpstrj");
  }
  if (scene.output.vtk) {
    append(names, vtk_names);
  }
  for (const SceneMeasure& measure : scene.measures) {
    append(names, measure_names_of(measure.plan));
  }
  if (std::ranges::any_of(scene.stages, [](const SceneStage& stage) { return stage.entry->has_table(); })) {
    names.emplace_back(stage_tables_name);
  }
  return names;
}

std::vector<std::string> files_of_measures(const MeasurePlan& plan) {
  std::vector<std::string> names = measure_names_of(plan);
  names.emplace_back(averages_name);
  return names;
}

void write_file_list(const OutputFolder& folder, const std::vector<std::string>& names) {
  OutputFile file(folder.file_list(), FileMode::overwrite);
  file.print("# Files of this run (* is a number). boba run --force removes these and nothing else.\n");
  for (const std::string& name : names) {
    file.print("{}\n", name);
  }
  file.close();
}

void add_to_file_list(const OutputFolder& folder, const std::vector<std::string>& names) {
  if (!is_there(folder.file_list())) {
    return;
  }
  const std::set<std::string> listed = names_in_list(folder);
  OutputFile file(folder.file_list(), FileMode::append);
  for (const std::string& name : names) {
    if (!listed.contains(name)) {
      file.print("{}\n", name);
    }
  }
  file.close();
}

std::vector<fs::path> files_written_in(const OutputFolder& folder) {
  if (!holds_run(folder)) {
    return {};
  }
  std::set<std::string> names = names_in_list(folder);
  if (names.empty()) {
    names = names_of_any_run();
  }
  return files_named(folder, {names.begin(), names.end()});
}

bool holds_run(const OutputFolder& folder) {
  std::vector<fs::path> checkpoints;
  add_files_of(folder.root(), "checkpoints/checkpoint-*.boba", checkpoints);
  return is_there(folder.file_list()) || (is_there(folder.scene()) && !checkpoints.empty());
}

std::vector<fs::path> files_read_by(const Scene& scene) {
  std::vector<fs::path> files = {scene.path};
  append(files, scene.start->files());
  return files;
}

void check_free(const OutputFolder& folder, const Scene& scene, bool force) {
  std::error_code error;
  const fs::path& root = folder.root();
  if (!fs::exists(root, error)) {
    return;
  }
  if (!fs::is_directory(root, error)) {
    throw InputError(fmt::format("output: {} is not a folder", root.string()));
  }
  const auto is_other = [&](const fs::directory_entry& entry) { return entry.path().filename() != lock_file_name; };
  const fs::directory_iterator entries(root, error);
  if (error) {
    throw InputError(fmt::format("output: {} cannot be read: {}", root.string(), error.message()));
  }
  if (std::none_of(begin(entries), end(entries), is_other)) {
    return;
  }
  if (!force) {
    throw InputError(
        fmt::format("output: {0} is there already and not empty; --force replaces the run in it, --output names "
                    "another folder, boba resume {0} continues it",
                    root.string()));
  }
  if (!holds_run(folder)) {
    throw InputError(fmt::format("output: {} is not empty and holds no run; --force replaces a run and nothing else, "
                                 "--output names another folder",
                                 root.string()));
  }
  check_room_for(folder, scene);
}

void remove_written(const OutputFolder& folder) {
  std::error_code error;
  for (const fs::path& file : files_written_in(folder)) {
    const bool is_replaced = file == folder.scene() || file == folder.file_list();
    if (!is_replaced && !fs::remove(file, error) && error) {
      throw std::runtime_error(fmt::format("output: {} cannot be removed: {}", file.string(), error.message()));
    }
  }
  for (const fs::path& emptied : {folder.vtk(), folder.measures(), folder.checkpoints()}) {
    if (fs::is_directory(fs::symlink_status(emptied, error))) {
      fs::remove(emptied, error); // stays when anything is left in it
    }
  }
}

} // namespace boba
