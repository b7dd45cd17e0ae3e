// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/measure_checks.h"

#include "bpm/app/measure/measure_tables.h"
#include "bpm/io/folder_lock.h"
#include "bpm/io/input_error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>

namespace boba {

namespace {

void check_between(const char* name, double value, double lowest, double highest, bool is_open) {
  const bool is_inside = is_open ? value > lowest && value < highest : value >= lowest && value <= highest;
  if (!is_inside || !std::isfinite(value)) {
    throw InputError(fmt::format("measure: {} is {}; it must be {} {:g} and {} {:g}", name, value,
                                 is_open ? "above" : "at least", lowest, is_open ? "below" : "at most", highest));
  }
}

void check_plan(const MeasurePlan& plan) {
  constexpr double largest = std::numeric_limits<double>::max();
  if (plan.is_empty()) {
    throw InputError("measure: --what names no measure");
  }
  check_between("--points", static_cast<double>(plan.packing_fraction.n_points), 1.0, 1e15, false);
  if (plan.packing_fraction.target_error) {
    check_between("--target-error", *plan.packing_fraction.target_error, 1e-5, 0.5, false);
  }
  check_between("--min-cosine", plan.facets.min_cosine, -1.0, 1.0, true);
  check_between("--min-area-share", plan.facets.min_area_share, 0.0, std::nextafter(1.0, 0.0), false);
  check_between("--q-max", plan.scattering.q_max, 0.0, largest, true);
  check_between("--shell-width", plan.scattering.shell_width, 0.0, largest, false);
}

/// Frames whose strain lies inside the window, of those that are chosen.
void check_window(const std::array<double, 2>& window, const TrajectoryReader& reader) {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  std::int64_t n_inside = 0;
  for (std::int64_t frame = 0; frame < reader.n_frames(); ++frame) {
    const double strain = reader.strain_of(frame);
    lowest = std::min(lowest, strain);
    highest = std::max(highest, strain);
    n_inside += strain > window[0] && strain < window[1] ? 1 : 0;
  }
  if (n_inside < 2) {
    throw InputError(
        fmt::format("measure: --window {:g} {:g} holds {} of the {} frames, an average needs two; their strains "
                    "are from {:g} to {:g}",
                    window[0], window[1], n_inside, reader.n_frames(), lowest, highest));
  }
}

void check_table(const std::filesystem::path& path, bool force) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    return;
  }
  if (!force) {
    throw InputError(
        fmt::format("measure: {} is there already; --force replaces it, --output names another folder", path.string()));
  }
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  if (!line.empty() && !line.starts_with("step,time_tau,strain")) {
    throw InputError(fmt::format(
        "measure: {} is no table of a measure and is left alone; --output names another folder", path.string()));
  }
}

} // namespace

std::filesystem::path trajectory_of(const std::filesystem::path& run) {
  return std::filesystem::is_directory(run) ? run / "trajectory.h5" : run;
}

std::filesystem::path folder_of(const MeasureRunOptions& options) {
  if (!options.output.empty()) {
    return options.output;
  }
  return (std::filesystem::is_directory(options.run) ? options.run : options.run.parent_path()) / "measures";
}

void check_measure_options(const MeasureRunOptions& options) {
  if (options.every < 1) {
    throw InputError(fmt::format("measure: --every is {}; it must be at least 1", options.every));
  }
  if (options.every_strain && !(*options.every_strain > 0.0)) {
    throw InputError(fmt::format("measure: --every-strain is {}; it must be positive", *options.every_strain));
  }
  if (options.window && !((*options.window)[0] < (*options.window)[1])) {
    throw InputError(fmt::format("measure: --window {:g} {:g}: the first strain must be the smaller one",
                                 (*options.window)[0], (*options.window)[1]));
  }
  check_plan(options.plan);
  std::error_code error;
  if (!std::filesystem::exists(options.run, error)) {
    throw InputError(fmt::format("measure: there is no {}", options.run.string()));
  }
  if (!std::filesystem::exists(trajectory_of(options.run), error)) {
    throw InputError(fmt::format("measure: {} holds no trajectory.h5: a run stores frames when its scene has "
                                 "[output.trajectory], for example with every_strain = 0.05",
                                 options.run.string()));
  }
}

void check_measure_frames(const MeasureRunOptions& options, const TrajectoryReader& reader) {
  const std::string file = trajectory_of(options.run).string();
  if (reader.n_frames() == 0) {
    throw InputError(fmt::format("{}: holds no complete frame yet", file));
  }
  if (options.only_frame) {
    reader.snapshot(*options.only_frame); // names what is there when the frame is not
  }
  if (options.window) {
    check_window(*options.window, reader);
  }
  const std::vector<std::int64_t>& first = reader.topology().first_node;
  for (std::size_t g = 0; g + 1 < first.size() && options.plan.needs_hulls(); ++g) {
    if (first[g + 1] - first[g] < MeasurePlan::fewest_nodes_of_hull) {
      throw InputError(
          fmt::format("measure: grain {} of {} has {} node{}: shape, packing-fraction and Voronoi neighbours "
                      "look at hulls, which need {}; --what names other measures",
                      reader.topology().molecule[g], file, first[g + 1] - first[g],
                      first[g + 1] - first[g] == 1 ? "" : "s", MeasurePlan::fewest_nodes_of_hull));
    }
  }
}

void check_measure_folder(const MeasureRunOptions& options) {
  const std::filesystem::path folder = folder_of(options);
  for (const MeasureTable& table : MeasureTables::tables_of(options.plan)) {
    check_table(folder / (table.name + ".csv"), options.force);
  }
  std::error_code error;
  const std::filesystem::path run = trajectory_of(options.run).parent_path();
  const std::string holder = FolderLock::holder_of(run / "run.lock");
  if (holder.empty() || !std::filesystem::equivalent(folder, run / "measures", error)) {
    return;
  }
  if (options.force) {
    throw InputError(fmt::format("measure: {} belongs to a run that is in use by {}: --force could replace what it "
                                 "writes; --output names another folder",
                                 folder.string(), holder));
  }
}

} // namespace boba
