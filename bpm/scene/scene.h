// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/simulation.h"
#include "bpm/laws/material.h"
#include "bpm/measure/measure_plan.h"
#include "bpm/stages/stage.h"
#include "bpm/stages/start.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// When something is written during a stage: whichever is due first. Both absent: only at the ends of stages.
struct OutputInterval {
  std::optional<double> strain;
  std::optional<double> time; ///< tau
};

struct FrameOutput {
  OutputInterval every;
  bool velocities = false;
};

struct OutputPlan {
  std::filesystem::path directory; ///< as the scene names it (relative), unless the command line does
  OutputInterval table;
  std::optional<FrameOutput> trajectory, dump, vtk;
  double checkpoint_seconds = 600.0;     ///< real time between two checkpoints
  std::optional<double> checkpoint_time; ///< tau between two checkpoints
};

/// A [[measure]]: what is measured while the run goes, and when.
struct SceneMeasure {
  MeasurePlan plan;
  OutputInterval every;
};

/// A [[stage]] after the start.
struct SceneStage {
  int index = 0;    ///< place in the scene's list, from 0
  std::string kind; ///< its type: "shear"
  std::string name; ///< its own, or ""
  std::shared_ptr<const StageEntry> entry;
  bool is_strict = false; ///< a target that it misses ends the run

  /// "stage.2 shear", and its own name when it has one.
  std::string label() const;
};

/// A run as a user describes it, complete and checked.
struct Scene {
  std::filesystem::path path;         ///< of the file, for messages and for the input files named in it
  std::string text;                   ///< the file as it was read
  std::vector<std::string> overrides; ///< of the command line, in order

  std::string title;
  std::uint64_t seed = 1;
  SimulationOptions options;
  bool automatic_dt = false;       ///< options.dt is to come from the packing: see settle_time_step
  std::optional<double> wall_time; ///< s
  OutputPlan output;
  std::vector<SceneMeasure> measures;
  Material material;
  std::vector<SceneTemplate> templates;
  std::vector<SceneSpecies> species;
  std::shared_ptr<const StartEntry> start;
  std::vector<SceneStage> stages;
};

/// Reads and checks a scene. Nothing is built and nothing is written.
/// \throws InputError with file, line, key, value and what is allowed.
Scene read_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides);

/// The same from a text that was read before (a checkpoint's): input files need not exist any more.
Scene read_stored_scene(const std::string& text, const std::filesystem::path& path,
                        const std::vector<std::string>& overrides);

} // namespace boba
