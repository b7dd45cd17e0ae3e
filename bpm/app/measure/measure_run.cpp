// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/measure_run.h"

#include "bpm/app/measure/measure_tables.h"
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_packing.h"
#include "bpm/measure/blocking.h"
#include "bpm/parallel/message_passing.h"
#include "bpm/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <omp.h>
#include <sstream>
#include <utility>

namespace boba {

namespace {

std::filesystem::path trajectory_of(const std::filesystem::path& run) {
  return std::filesystem::is_directory(run) ? run / "trajectory.h5" : run;
}

std::filesystem::path folder_of(const MeasureRunOptions& options) {
  if (!options.output.empty()) {
    return options.output;
  }
  return (std::filesystem::is_directory(options.run) ? options.run : options.run.parent_path()) / "measures";
}

void check(const MeasureRunOptions& options) {
  if (options.every < 1) {
    throw InputError(fmt::format("measure: --every is {}; it must be at least 1", options.every));
  }
  if (options.every_strain && !(*options.every_strain > 0.0)) {
    throw InputError(fmt::format("measure: --every-strain is {}; it must be positive", *options.every_strain));
  }
  if (options.plan.kinds.empty()) {
    throw InputError("measure: nothing is asked for; --what names the measures");
  }
}

/// Decides frame by frame, so that frames which are skipped are read no further than their strain.
class FrameChoice {
public:
  FrameChoice(const MeasureRunOptions& options, std::int64_t n_frames) : options_(options) {
    if (options.only_frame) {
      only_ = *options.only_frame < 0 ? n_frames + *options.only_frame : *options.only_frame;
    }
  }
  bool may_take(std::int64_t frame) const {
    if (only_) {
      return frame == *only_;
    }
    return options_.every_strain || frame % options_.every == 0;
  }
  bool takes(const Snapshot& snapshot) {
    if (only_ || !options_.every_strain) {
      return true;
    }
    // A hair less than the interval: strains are sums of many steps.
    if (std::abs(snapshot.strain - last_strain_) < *options_.every_strain * (1.0 - 1e-6)) {
      return false;
    }
    last_strain_ = snapshot.strain;
    return true;
  }

private:
  const MeasureRunOptions& options_;
  std::optional<std::int64_t> only_;
  double last_strain_ = std::numeric_limits<double>::infinity(); ///< none yet: any frame is far from it
};

/// The scene that a trajectory came from; nothing when it names none that can be read.
std::optional<Scene> scene_of(const TrajectoryOrigin& origin, const std::filesystem::path& path) {
  std::vector<std::string> overrides;
  const std::string mark = "# --set ";
  std::istringstream lines(origin.scene);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(mark)) {
      overrides.push_back(line.substr(mark.size()));
    }
  }
  try {
    return read_stored_scene(origin.scene, path, overrides);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// What evaluates the forces anew, or the reason why it cannot.
std::pair<std::shared_ptr<FrameStress>, std::string>
frame_stress(const MeasureRunOptions& options, const std::optional<Scene>& scene, const Ranks& ranks) {
  if (options.stored_stress) {
    return {nullptr, "it was asked for"};
  }
  if (!scene) {
    return {nullptr, "the trajectory names no scene to take the material from"};
  }
  const auto has_ends = [](const SceneStage& stage) { return stage.entry->has_ends(); };
  if (std::any_of(scene->stages.begin(), scene->stages.end(), has_ends)) {
    return {nullptr, "the run has walls or clamps, which frames do not hold"};
  }
  try {
    Packing packing = read_trajectory_packing(trajectory_of(options.run), 0, std::nullopt);
    return {std::make_shared<FrameStress>(std::move(packing), scene->material, scene->options.dt, ranks), ""};
  } catch (const InputError& error) {
    return {nullptr, error.what()};
  }
}

/// What lets copies of frames come to rest. \throws InputError when forces or walls are not known.
std::shared_ptr<const FrameRest> frame_rest(const MeasureRunOptions& options, const std::optional<Scene>& scene) {
  if (!scene) {
    throw InputError("measure: --relaxed needs the material, but the trajectory names no scene to take it from");
  }
  return std::make_shared<const FrameRest>(read_trajectory_packing(trajectory_of(options.run), 0, std::nullopt),
                                           scene->material, scene->options.dt, *options.plan.rest);
}

/// The tables, and what there is to say of them.
std::unique_ptr<MeasureTables> open_tables(const MeasureRunOptions& options, const TrajectoryReader& reader,
                                           const Ranks& ranks, MeasureRunResult& result) {
  result.folder = folder_of(options);
  result.velocity_known = reader.has_velocity();
  const UndeformedGrains undeformed = undeformed_grains(reader.topology(), reader.snapshot(0));
  result.undeformed_known =
      std::none_of(undeformed.nodes.begin(), undeformed.nodes.end(), [](const auto& nodes) { return nodes.empty(); });
  const std::optional<Scene> scene = scene_of(reader.origin(), trajectory_of(options.run));
  MeasurePlan plan = options.plan;
  plan.material = scene ? scene->material : plan.material;
  const FileMode mode = options.force ? FileMode::overwrite : FileMode::create;
  auto tables = std::make_unique<MeasureTables>(result.folder, reader.topology(), plan, undeformed, mode, -1, ranks);
  if (plan.rest && plan.has(MeasureKind::order) && ranks.is_root()) {
    tables->set_frame_rest(frame_rest(options, scene));
  }
  if (plan.has(MeasureKind::stress)) {
    auto [stress, reason] = frame_stress(options, scene, ranks);
    tables->set_frame_stress(std::move(stress));
    result.stored_stress = std::move(reason);
  }
  return tables;
}

/// averages.json and the same for the terminal.
std::string write_averages(const std::filesystem::path& path, const MeasureTables& tables,
                           const std::optional<std::array<double, 2>>& window) {
  nlohmann::json json;
  std::string lines;
  for (const auto& [name, series] : tables.series()) {
    std::vector<double> values;
    for (std::size_t i = 0; i < series.value.size(); ++i) {
      if (!window || (series.strain[i] > (*window)[0] && series.strain[i] < (*window)[1])) {
        values.push_back(series.value[i]);
      }
    }
    if (values.size() < 2) {
      continue;
    }
    const measure::BlockedMean mean = measure::blocked_mean(values);
    json[name] = {{"mean", mean.mean},
                  {"standard_error", mean.standard_error},
                  {"values", mean.n_values},
                  {"block_size", mean.block_size},
                  {"reached_plateau", mean.reached_plateau}};
    lines += fmt::format("{:20s} {:.6g} +- {:.2g} ({} frames{})\n", name, mean.mean, mean.standard_error, mean.n_values,
                         mean.reached_plateau ? "" : "; too few to know the error well");
  }
  if (!json.empty()) {
    if (window) {
      json["strain_window"] = *window;
    }
    std::ofstream file(path);
    file << json.dump(2) << '\n';
    if (!file.flush()) {
      throw std::runtime_error(fmt::format("{}: cannot be written", path.string()));
    }
  }
  return lines;
}

} // namespace

MeasureRunResult measure_run(const MeasureRunOptions& options, const Ranks& ranks) {
  if (options.threads > 0 || ranks.is_distributed()) {
    omp_set_num_threads(options.threads > 0 ? options.threads : threads_of_a_rank(ranks));
  }
  std::optional<TrajectoryReader> reader;
  ranks.collectively([&] {
    check(options);
    reader.emplace(trajectory_of(options.run));
    if (reader->n_frames() == 0) {
      throw InputError(fmt::format("{}: holds no complete frame yet", trajectory_of(options.run).string()));
    }
    if (options.only_frame) {
      reader->snapshot(*options.only_frame); // names what is there when the frame is not
    }
  });
  // A run that goes on may have added a frame between the looks of two ranks.
  const auto n_frames = static_cast<std::int64_t>(ranks.smallest(static_cast<double>(reader->n_frames())));
  MeasureRunResult result;
  std::unique_ptr<MeasureTables> tables;
  ranks.collectively([&] { tables = open_tables(options, *reader, ranks, result); });
  FrameChoice choice(options, n_frames);
  for (std::int64_t frame = 0; frame < n_frames; ++frame) {
    if (!choice.may_take(frame)) {
      continue;
    }
    Snapshot snapshot;
    ranks.collectively([&] { snapshot = reader->snapshot(frame); });
    if (choice.takes(snapshot)) {
      tables->add(snapshot);
      ++result.n_frames;
    }
  }
  ranks.on_root([&] { result.averages = write_averages(result.folder / "averages.json", *tables, options.window); });
  return result;
}

} // namespace boba
