// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/continued_run.h"

#include "bpm/io/input_error.h"
#include "bpm/stages/trajectory_start.h"
#include "bpm/toml/toml_node.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>
#include <utility>

namespace boba {

namespace {

/// The overrides of the run that stored the text: behind its mark. Files of version 0.1 have no mark; there they are
/// the last lines. Comments of the same form before that came with the scene and mean nothing.
std::vector<std::string> overrides_behind(const std::string& text) {
  const std::string begin = "# --set ";
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(begin)) {
      overrides.push_back(line.substr(begin.size()));
    } else if (!line.empty()) {
      overrides.clear();
    }
  }
  return overrides;
}

/// The table [material] of a scene; without members when it gives none.
TomlNode material_of(const std::string& text, const std::filesystem::path& path,
                     const std::vector<std::string>& overrides) {
  TomlNode tree = parse_toml(text, path.string());
  for (const std::string& assignment : overrides) {
    apply_override(tree, assignment);
  }
  const TomlNode* material = tree.find("material");
  return material != nullptr ? *material : TomlNode();
}

/// A value as TOML reads it again, to the last bit.
std::string value_text(const TomlNode& node) {
  switch (node.kind) {
  case TomlNode::Kind::real:
    return fmt::format("{}", node.real);
  case TomlNode::Kind::integer:
    return fmt::format("{}", node.integer);
  case TomlNode::Kind::boolean:
    return node.boolean ? "true" : "false";
  default:
    return node.shown;
  }
}

/// What applies of both tables, and the assignments that bring the stored one's part into the scene.
struct Inheritance {
  std::vector<std::string> assignments, told;
};

Inheritance inherit(const TomlNode& own, const TomlNode& stored) {
  Inheritance result;
  for (const auto& [key, value] : stored.members) {
    if (own.find(key) == nullptr) {
      result.assignments.push_back(fmt::format("material.{}={}", key, value_text(value)));
      result.told.push_back(fmt::format("{} = {}", key, value_text(value)));
    }
  }
  for (const auto& [key, value] : own.members) {
    const TomlNode* other = stored.find(key);
    const std::string before = other != nullptr ? value_text(*other) : "the default";
    const std::string instead = before == value_text(value) ? "" : " instead of " + before;
    result.told.push_back(fmt::format("{} = {} (of the scene){}", key, value_text(value), instead));
  }
  return result;
}

} // namespace

std::optional<Scene> scene_of_trajectory(const TrajectoryOrigin& origin, const std::filesystem::path& path) {
  try {
    return read_stored_scene(origin.scene, path, overrides_behind(origin.scene));
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Scene read_scene_to_run(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                        const Narrator& narrate) {
  Scene scene = read_scene(path, overrides);
  if (dynamic_cast<const TrajectoryStart*>(scene.start.get()) == nullptr) {
    return scene;
  }
  const std::filesystem::path file = scene.start->files().front();
  const TrajectoryOrigin origin = TrajectoryReader(file).origin();
  if (!scene_of_trajectory(origin, file)) {
    narrate(fmt::format("warning: {} names no scene that can be read: its material is not known, that of {} applies",
                        file.string(), path.string()));
    return scene;
  }
  const Inheritance inherited = inherit(material_of(scene.text, path, scene.overrides),
                                        material_of(origin.scene, file, overrides_behind(origin.scene)));
  narrate(fmt::format("material of {}: {}", file.string(),
                      inherited.told.empty() ? "the default" : fmt::format("{}", fmt::join(inherited.told, ", "))));
  if (inherited.assignments.empty()) {
    return scene;
  }
  std::vector<std::string> all = overrides;
  all.insert(all.end(), inherited.assignments.begin(), inherited.assignments.end());
  try {
    return read_scene(path, all);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: what [material] gives does not go with the rest of {}'s material; give all of it "
                                 "({})",
                                 path.string(), file.string(), error.what()));
  }
}

} // namespace boba
