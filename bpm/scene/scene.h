// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/simulation.h"
#include "bpm/grain/template_spec.h"
#include "bpm/laws/material.h"
#include "bpm/measure/measure_plan.h"
#include "bpm/stages/compress.h"
#include "bpm/stages/hold.h"
#include "bpm/stages/press.h"
#include "bpm/stages/shear.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
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

struct SceneTemplate {
  std::string name;
  TemplateSpec spec;
};

/// How the many-body coefficient of some grains is given.
struct AlphaChoice {
  std::optional<double> alpha;   ///< k d
  std::optional<double> poisson; ///< looked up in the installed table
};

struct SceneSpecies {
  std::string name;
  int template_index = 0;
  std::int64_t count = 0;
  AlphaChoice material;
};

/// What the packing is at the start.
struct InsertStart {
  double packing_fraction = 0.4; ///< sum of reference volumes over cell volume
  bool rotate = true;
};
struct SpecimenStart {
  double margin = 5.0; ///< d
};
struct LammpsStart {
  std::filesystem::path reference;
  std::optional<std::filesystem::path> state;
  int frame = -1;
  AlphaChoice material;
};
struct TrajectoryStart {
  std::filesystem::path file;
  int frame = -1;
  AlphaChoice material;
};

using Stage = std::variant<CompressStage, HoldStage, ShearStage, PressStage>;

std::unique_ptr<StageDriver> make_stage_driver(const Stage& stage);

struct SceneStage {
  int index = 0; ///< place in the scene's list, from 0
  Stage stage;
  std::optional<double> normalised_pressure; ///< replaces the barostat's pressure once E and nu are known
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
  std::variant<InsertStart, SpecimenStart, LammpsStart, TrajectoryStart> start;
  std::vector<SceneStage> stages;
};

/// Reads and checks a scene. Nothing is built and nothing is written.
/// \throws InputError with file, line, key, value and what is allowed.
Scene read_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides);

/// The same from a text that was read before (a checkpoint's): input files need not exist any more.
Scene read_stored_scene(const std::string& text, const std::filesystem::path& path,
                        const std::vector<std::string>& overrides);

} // namespace boba
