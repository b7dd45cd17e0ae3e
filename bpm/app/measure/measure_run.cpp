// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/measure_run.h"

#include "bpm/app/measure/measure_tables.h"
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory.h"
#include "bpm/measure/blocking.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <omp.h>

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

MeasureRunResult measure_run(const MeasureRunOptions& options) {
  check(options);
  if (options.threads > 0) {
    omp_set_num_threads(options.threads);
  }
  const TrajectoryReader reader(trajectory_of(options.run));
  if (reader.n_frames() == 0) {
    throw InputError(fmt::format("{}: holds no complete frame yet", trajectory_of(options.run).string()));
  }
  if (options.only_frame) {
    reader.snapshot(*options.only_frame); // names what is there when the frame is not
  }
  MeasureRunResult result;
  result.folder = folder_of(options);
  result.velocity_known = reader.has_velocity();
  UndeformedGrains undeformed = undeformed_grains(reader.topology(), reader.snapshot(0));
  result.undeformed_known =
      std::none_of(undeformed.nodes.begin(), undeformed.nodes.end(), [](const auto& nodes) { return nodes.empty(); });
  MeasureTables tables(result.folder, reader.topology(), options.plan, std::move(undeformed),
                       options.force ? FileMode::overwrite : FileMode::create);
  FrameChoice choice(options, reader.n_frames());
  for (std::int64_t frame = 0; frame < reader.n_frames(); ++frame) {
    if (!choice.may_take(frame)) {
      continue;
    }
    const Snapshot snapshot = reader.snapshot(frame);
    if (choice.takes(snapshot)) {
      tables.add(snapshot);
      ++result.n_frames;
    }
  }
  result.averages = write_averages(result.folder / "averages.json", tables, options.window);
  return result;
}

} // namespace boba
