// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/scene_stages.h"

#include "bpm/dynamics/step_count.h"
#include "bpm/io/input_error.h"

#include <fmt/format.h>

namespace boba {

namespace {

std::optional<Barostat> read_barostat(const SceneTable& table, std::optional<double>& normalised) {
  const auto pressure = table.maybe_real("pressure");
  normalised = table.maybe_real("normalised_pressure");
  if (pressure && normalised) {
    table.fail("normalised_pressure", "is given together with pressure; give one of them");
  }
  if (!pressure && !normalised) {
    for (const char* key : {"gain", "rate_cap"}) {
      if (table.has(key)) {
        table.fail(key, "needs pressure or normalised_pressure");
      }
    }
    return std::nullopt;
  }
  Barostat barostat;
  barostat.pressure = pressure.value_or(0.0);
  barostat.gain = table.maybe_real("gain");
  barostat.rate_cap = table.real("rate_cap", barostat.rate_cap);
  return barostat;
}

SceneStage read_compress(const SceneTable& table) {
  SceneStage result;
  CompressStage stage;
  const std::optional<Barostat> barostat = read_barostat(table, result.normalised_pressure);
  if (!barostat) {
    table.fail("pressure", "or normalised_pressure must be given");
  }
  stage.barostat = *barostat;
  stage.rate = table.real("rate", stage.rate);
  stage.pressure_tolerance = table.real("pressure_tolerance", stage.pressure_tolerance);
  stage.kinetic_tolerance = table.real("kinetic_tolerance", stage.kinetic_tolerance);
  stage.max_time = table.real("max_time", stage.max_time);
  result.stage = stage;
  return result;
}

SceneStage read_hold(const SceneTable& table) {
  SceneStage result;
  HoldStage stage;
  stage.time = table.real("time", 0.0);
  stage.barostat = read_barostat(table, result.normalised_pressure);
  result.stage = stage;
  return result;
}

SceneStage read_shear(const SceneTable& table) {
  SceneStage result;
  ShearStage stage;
  stage.rate = table.real("rate", 0.0);
  if (stage.rate == 0.0) {
    table.fail("rate", "must not be 0");
  }
  stage.strain = table.real("strain", 0.0);
  stage.remap = table.text("remap", "positions") == "positions" ? Remap::positions : Remap::velocities;
  stage.barostat = read_barostat(table, result.normalised_pressure);
  result.stage = stage;
  return result;
}

SceneStage read_press(const SceneTable& table) {
  PressStage stage;
  stage.strain = table.real("strain", 0.0);
  stage.ends = table.text("ends", "walls") == "walls" ? PressStage::Ends::walls : PressStage::Ends::clamps;
  stage.velocity = table.real("velocity", stage.velocity);
  stage.clamp_thickness = table.real("clamp_thickness", stage.clamp_thickness);
  if (stage.velocity == 0.0) {
    table.fail("velocity", "must not be 0");
  }
  if (stage.ends == PressStage::Ends::walls && stage.velocity < 0.0) {
    table.fail("velocity", "must be positive: walls can only push (ends = \"clamps\" can pull)");
  }
  if (stage.ends == PressStage::Ends::walls && table.has("clamp_thickness")) {
    table.fail("clamp_thickness", "needs ends = \"clamps\"");
  }
  return {0, stage, std::nullopt};
}

/// A cell that is open on its sides cannot be compressed or sheared, and ends need an open one.
void check_cell(const SceneTable& table, const SceneStage& stage, const Scene& scene) {
  const bool specimen = std::holds_alternative<SpecimenStart>(scene.start);
  const bool periodic_specimen =
      specimen && scene.templates[scene.species.front().template_index].spec.shape == TemplateSpec::Shape::periodic_box;
  const bool open = specimen && !periodic_specimen;
  if (std::holds_alternative<PressStage>(stage.stage) && !open) {
    table.fail("type", "needs an open cell: begin with a \"specimen\" stage");
  }
  const auto* hold = std::get_if<HoldStage>(&stage.stage);
  const bool moves_cell = std::holds_alternative<CompressStage>(stage.stage) ||
                          std::holds_alternative<ShearStage>(stage.stage) || (hold != nullptr && hold->barostat);
  if (moves_cell && open) {
    table.fail("type", "needs a periodic cell; a specimen's is open");
  }
}

/// A stage that no run could end is a slip of the pen. What only the specimen's height tells is found when it begins.
void check_length(const SceneTable& table, const SceneStage& stage, double dt) {
  const auto check = [&](const char* key, double duration) {
    if (!(duration / dt <= most_steps)) {
      table.fail(key, fmt::format("makes a stage of {:g} steps; allowed: at most {:g}", duration / dt, most_steps));
    }
  };
  if (const auto* hold = std::get_if<HoldStage>(&stage.stage)) {
    check("time", hold->time);
  } else if (const auto* shear = std::get_if<ShearStage>(&stage.stage)) {
    check("rate", shear->strain / std::abs(shear->rate));
  } else if (const auto* press = std::get_if<PressStage>(&stage.stage)) {
    check("velocity", press->strain / std::abs(press->velocity)); // of the lowest specimen, two nodes high
  }
}

template <class... Cases> struct Overloaded : Cases... { using Cases::operator()...; };
template <class... Cases> Overloaded(Cases...) -> Overloaded<Cases...>;

} // namespace

std::unique_ptr<StageDriver> make_stage_driver(const Stage& stage) {
  using Made = std::unique_ptr<StageDriver>;
  return std::visit(Overloaded{[](const CompressStage& s) -> Made { return std::make_unique<CompressDriver>(s); },
                               [](const HoldStage& s) -> Made { return std::make_unique<HoldDriver>(s); },
                               [](const ShearStage& s) -> Made { return std::make_unique<ShearDriver>(s); },
                               [](const PressStage& s) -> Made { return std::make_unique<PressDriver>(s); }},
                    stage);
}

std::vector<SceneStage> read_stages(const SceneTables& tables, const Scene& scene) {
  std::vector<SceneStage> stages;
  const std::vector<SceneTable>& list = tables.list("stage");
  const bool from_files = tables.present.at("start");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string& kind = list[i].kind();
    if (kind == "insert" || kind == "specimen") {
      if (i > 0 || from_files) {
        list[i].fail("type", from_files ? "has no place after [start]" : "can only be the first stage");
      }
      continue;
    }
    SceneStage stage = kind == "compress" ? read_compress(list[i])
                       : kind == "hold"   ? read_hold(list[i])
                       : kind == "shear"  ? read_shear(list[i])
                                          : read_press(list[i]);
    stage.index = static_cast<int>(i);
    check_cell(list[i], stage, scene);
    check_length(list[i], stage, scene.options.dt);
    stages.push_back(stage);
  }
  if (from_files && stages.empty()) {
    throw InputError(fmt::format("{}: no [[stage]]: nothing to do", scene.path.string()));
  }
  return stages;
}

} // namespace boba
