// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/measure_run.h"

#include "bpm/app/measure/averages_file.h"
#include "bpm/app/measure/measure_checks.h"
#include "bpm/app/measure/measure_tables.h"
#include "bpm/io/folder_lock.h"
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_packing.h"
#include "bpm/parallel/message_passing.h"
#include "bpm/parallel/usable_cores.h"
#include "bpm/scene/continued_run.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <omp.h>
#include <utility>

namespace boba {

namespace {

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
  bool takes(double strain) {
    if (only_ || !options_.every_strain) {
      return true;
    }
    // A hair less than the interval: strains are sums of many steps.
    if (std::abs(strain - last_strain_) < *options_.every_strain * (1.0 - 1e-6)) {
      return false;
    }
    last_strain_ = strain;
    return true;
  }

private:
  const MeasureRunOptions& options_;
  std::optional<std::int64_t> only_;
  double last_strain_ = std::numeric_limits<double>::infinity(); ///< none yet: any frame is far from it
};

/// What evaluates the forces again, or the reason why it cannot.
std::pair<std::shared_ptr<FrameStress>, std::string>
frame_stress(const MeasureRunOptions& options, const std::optional<Scene>& scene, const Ranks& ranks) {
  if (options.stored_stress) {
    return {nullptr, "--stored-stress was given"};
  }
  if (!scene) {
    return {nullptr, "the trajectory names no scene to take the material from"};
  }
  const auto has_ends = [](const SceneStage& stage) { return stage.entry->has_ends(); };
  if (std::any_of(scene->stages.begin(), scene->stages.end(), has_ends)) {
    return {nullptr, "the run has walls or clamps, which frames do not hold"};
  }
  try {
    Packing packing = read_trajectory_packing(trajectory_of(options.run), 0);
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
  return std::make_shared<const FrameRest>(read_trajectory_packing(trajectory_of(options.run), 0), scene->material,
                                           scene->options.dt, *options.plan.rest);
}

/// The tables, and what there is to say of them.
std::unique_ptr<MeasureTables> open_tables(const MeasureRunOptions& options, const TrajectoryReader& reader,
                                           const Ranks& ranks, MeasureRunResult& result) {
  result.folder = folder_of(options);
  result.velocity_known = reader.has_velocity();
  const UndeformedGrains undeformed = undeformed_grains(reader.topology(), reader.snapshot(0));
  result.undeformed_known =
      std::none_of(undeformed.nodes.begin(), undeformed.nodes.end(), [](const auto& nodes) { return nodes.empty(); });
  const std::optional<Scene> scene = scene_of_trajectory(reader.origin(), trajectory_of(options.run));
  MeasurePlan plan = options.plan;
  plan.material = scene ? scene->material : plan.material;
  const FileMode mode = options.force ? FileMode::overwrite : FileMode::create;
  auto tables = std::make_unique<MeasureTables>(result.folder, reader.topology(), plan, undeformed, mode, -1, ranks,
                                                MeasureTables::Opening::with_first_frame);
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

/// The folder of the tables, for this process alone; one that was made and stays empty is removed again.
class TablesFolder {
public:
  explicit TablesFolder(const std::filesystem::path& folder) : folder_(folder) {
    is_made_ = std::filesystem::create_directories(folder_);
    lock_ = std::make_unique<FolderLock>(folder_ / "measure.lock", "boba measure");
  }
  TablesFolder(const TablesFolder&) = delete;
  TablesFolder& operator=(const TablesFolder&) = delete;
  ~TablesFolder() {
    lock_.reset();
    std::error_code ignored;
    if (is_made_) {
      std::filesystem::remove(folder_, ignored); // only when it is empty
    }
  }

private:
  std::filesystem::path folder_;
  bool is_made_ = false;
  std::unique_ptr<FolderLock> lock_;
};

/// Measures the frames that are chosen. What is wrong with the first one is wrong input: nothing has been written by
/// then.
void measure_frames(const MeasureRunOptions& options, const TrajectoryReader& reader, const Ranks& ranks,
                    MeasureTables& tables, std::int64_t& n_measured) {
  // A run that goes on may have added a frame between the looks of two ranks.
  const auto n_frames = static_cast<std::int64_t>(ranks.smallest(static_cast<double>(reader.n_frames())));
  FrameChoice choice(options, n_frames);
  for (std::int64_t frame = 0; frame < n_frames; ++frame) {
    if (!choice.may_take(frame)) {
      continue;
    }
    double strain = 0.0;
    ranks.collectively([&] { strain = reader.strain_of(frame); });
    if (!choice.takes(strain)) {
      continue;
    }
    Snapshot snapshot;
    ranks.collectively([&] { snapshot = reader.snapshot(frame); });
    const auto told = [&](const std::exception& error) {
      return fmt::format("frame {} (step {}): {}; the tables hold the frames before it", frame, snapshot.step,
                         error.what());
    };
    try {
      tables.add(snapshot);
    } catch (const RankError& error) {
      if (n_measured == 0 || !error.is_wrong_input) {
        throw;
      }
      throw RankError(error.rank, false, told(error));
    } catch (const std::invalid_argument& error) {
      if (n_measured == 0) {
        throw;
      }
      throw std::runtime_error(told(error));
    }
    ++n_measured;
  }
}

/// Threads of this process: as many as it is told, or as the machine gives it.
void choose_threads(const MeasureRunOptions& options, const Ranks& ranks) {
  if (options.threads > 0 || ranks.is_distributed()) {
    omp_set_num_threads(options.threads > 0 ? options.threads : threads_of_a_rank(ranks));
  } else if (std::getenv("OMP_NUM_THREADS") == nullptr) {
    omp_set_num_threads(usable_cores());
  }
}

} // namespace

MeasureRunResult measure_run(const MeasureRunOptions& options, const Ranks& ranks) {
  choose_threads(options, ranks);
  std::optional<TrajectoryReader> reader;
  std::optional<AveragesFile> averages;
  std::unique_ptr<TablesFolder> folder;
  ranks.collectively([&] {
    check_measure_options(options);
    reader.emplace(trajectory_of(options.run));
    check_measure_frames(options, *reader);
  });
  MeasureRunResult result;
  std::unique_ptr<MeasureTables> tables;
  ranks.on_root([&] {
    check_measure_folder(options);
    folder = std::make_unique<TablesFolder>(folder_of(options));
    averages.emplace(folder_of(options) / "averages.json");
  });
  ranks.collectively([&] { tables = open_tables(options, *reader, ranks, result); });
  measure_frames(options, *reader, ranks, *tables, result.n_frames);
  ranks.on_root([&] { result.averages = averages->write(tables->series(), options.window); });
  return result;
}

} // namespace boba
