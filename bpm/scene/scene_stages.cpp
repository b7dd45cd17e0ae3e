// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/scene_stages.h"

#include "bpm/io/input_error.h"
#include "bpm/stages/stage_registry.h"
#include "bpm/stages/start_registry.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <set>

namespace boba {

namespace {

/// A stage's own name, which `--set stage.NAME.key=...` must be able to tell from types and numbers.
std::string read_name(const SceneTable& table, std::set<std::string>& taken) {
  const std::string name = table.text("name", "");
  const bool is_number = std::ranges::all_of(name, [](unsigned char c) { return std::isdigit(c) != 0; });
  const bool is_path = name.find_first_of(".= ") != std::string::npos;
  const bool is_type = find_stage_kind(name) != nullptr || find_placing_start(name) != nullptr;
  if (table.has("name") && (name.empty() || is_number || is_path || is_type || !taken.insert(name).second)) {
    table.fail("name", "must be a word that no other stage has: no number, no type of stage, without spaces, \".\" and "
                       "\"=\"");
  }
  return name;
}

} // namespace

std::string SceneStage::label() const {
  return fmt::format("stage.{} {}{}", index, kind, name.empty() ? "" : " \"" + name + "\"");
}

std::vector<SceneStage> read_stages(const SceneTables& tables, const Scene& scene) {
  const StageSurroundings surroundings = {scene.start->cell_is_open({scene.templates, scene.species}), scene.options.dt,
                                          scene.material};
  const bool from_files = tables.present.at("start");
  std::vector<SceneStage> stages;
  std::set<std::string> names;
  const std::vector<SceneTable>& list = tables.list("stage");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const SceneTable& table = list[i];
    if (find_placing_start(table.kind()) != nullptr) {
      if (i > 0 || from_files) {
        table.fail("type", from_files ? "has no place after [start]" : "can only be the first stage");
      }
      continue;
    }
    const StageKind* kind = find_stage_kind(table.kind());
    if (kind == nullptr) {
      throw std::logic_error(fmt::format("the stage \"{}\" has keys but is not registered", table.kind()));
    }
    stages.push_back({static_cast<int>(i), table.kind(), read_name(table, names), kind->read(table),
                      table.boolean("strict", false)});
    stages.back().entry->check(table, surroundings);
  }
  if (from_files && stages.empty()) {
    throw InputError(fmt::format("{}: no [[stage]]: nothing to do", scene.path.string()));
  }
  return stages;
}

StageContext stage_context(const Scene& scene, const Packing& packing, std::optional<double> modulus) {
  return {scene.path.string(), packing, PackingNumbers(packing, scene.material, modulus)};
}

std::vector<PreparedStage> prepare_stages(const Scene& scene, const StageContext& context) {
  const std::array<bool, 3> periodic = context.packing.box.periodic();
  const bool is_open = !std::ranges::all_of(periodic, [](bool along) { return along; });
  for (int axis = 0; axis < 3; ++axis) {
    if (periodic[axis] && scene.material.gravity[axis] != 0.0) {
      throw InputError(fmt::format("{}: material.gravity[{}] = {:g}: the cell is periodic along {}, where grains would "
                                   "fall without end; allowed there: 0",
                                   scene.path.string(), axis, scene.material.gravity[axis], "xyz"[axis]));
    }
  }
  std::vector<PreparedStage> prepared;
  for (const SceneStage& stage : scene.stages) {
    if (is_open && stage.entry->moves_cell()) { // a packing from files: no key of the scene tells
      throw InputError(fmt::format("{}: {}: moves the cell, which must be periodic along x, y and z for that; the cell "
                                   "of the packing that [start] reads is open",
                                   scene.path.string(), stage.label()));
    }
    prepared.push_back({stage.index, stage.label(), stage.entry->make_driver(context), stage.is_strict});
  }
  return prepared;
}

} // namespace boba
