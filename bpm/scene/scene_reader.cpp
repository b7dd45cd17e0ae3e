// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/contact_laws.h"
#include "bpm/io/input_error.h"
#include "bpm/laws/hertz.h"
#include "bpm/parallel/usable_cores.h"
#include "bpm/scene/override_text.h"
#include "bpm/scene/read_sizes.h"
#include "bpm/scene/read_template.h"
#include "bpm/scene/scene.h"
#include "bpm/scene/scene_schema.h"
#include "bpm/scene/scene_size.h"
#include "bpm/scene/scene_stages.h"
#include "bpm/stages/start_registry.h"
#include "bpm/toml/scene_table.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <sstream>
#include <utility>

namespace boba {

namespace {

void read_run(const SceneTable& table, Scene& scene) {
  scene.automatic_dt = table.is_text("dt");
  scene.options.dt = scene.automatic_dt ? scene.options.dt : table.real("dt", scene.options.dt);
  scene.options.skin = table.real("skin", scene.options.skin);
  scene.options.precision = table.text("precision", "double") == "mixed" ? Precision::mixed : Precision::full;
  const auto threads = static_cast<int>(table.integer("threads", 0));
  scene.options.threads = threads > 0 ? threads : usable_cores();
  scene.wall_time = table.maybe_real("wall_time");
}

OutputInterval read_interval(const SceneTable& table) {
  return {table.maybe_real("every_strain"), table.maybe_real("every_time")};
}

std::optional<FrameOutput> read_frames(const SceneTables& tables, const std::string& path) {
  if (!tables.present.at(path)) {
    return std::nullopt;
  }
  const SceneTable& table = tables.table(path);
  return FrameOutput{read_interval(table), table.boolean("velocities", false)};
}

OutputPlan read_output(const SceneTables& tables, const std::filesystem::path& scene_path) {
  OutputPlan plan;
  const SceneTable& output = tables.table("output");
  plan.directory = output.text("directory", (std::filesystem::path("out") / scene_path.stem()).string());
  const bool climbs = std::find(plan.directory.begin(), plan.directory.end(), "..") != plan.directory.end();
  if (plan.directory.empty() || plan.directory.is_absolute() || climbs ||
      plan.directory.string().find('\0') != std::string::npos) {
    output.fail("directory", "must be a relative path without \"..\"; the command line's --output may name any folder");
  }
  plan.table = read_interval(tables.table("output.table"));
  if (!plan.table.strain && !plan.table.time) {
    plan.table = {0.01, 100.0};
  }
  plan.trajectory = read_frames(tables, "output.trajectory");
  plan.dump = read_frames(tables, "output.dump");
  plan.vtk = read_frames(tables, "output.vtk");
  const SceneTable& checkpoint = tables.table("output.checkpoint");
  plan.checkpoint_seconds = checkpoint.real("every_seconds", plan.checkpoint_seconds);
  plan.checkpoint_time = checkpoint.maybe_real("every_time");
  return plan;
}

MeasurePlan read_measure_plan(const SceneTable& table, const Scene& scene) {
  MeasurePlan plan;
  plan.material = scene.material;
  std::vector<std::string> names;
  std::istringstream what(table.text("what", ""));
  for (std::string name; std::getline(what, name, ',');) {
    name.erase(0, name.find_first_not_of(' '));
    name.erase(name.find_last_not_of(' ') + 1);
    names.push_back(name);
  }
  try {
    choose_measures(plan, names);
  } catch (const std::invalid_argument& error) {
    table.fail("what", error.what());
  }
  if (plan.is_empty()) {
    table.fail("what", "names no measure");
  }
  plan.neighbours =
      table.text("neighbours", "solid-angle") == "voronoi" ? NeighbourRule::voronoi : NeighbourRule::solid_angle;
  for (const SceneTemplate& t : scene.templates) {
    if (plan.needs_hulls() && expected_nodes(t.spec) < MeasurePlan::fewest_nodes_of_hull) {
      table.fail("what", fmt::format("looks at the hulls of grains, which need {} nodes and more; template \"{}\" has "
                                     "{:.0f}",
                                     MeasurePlan::fewest_nodes_of_hull, t.name, expected_nodes(t.spec)));
    }
  }
  plan.packing_fraction.n_points = table.integer("points", plan.packing_fraction.n_points);
  plan.packing_fraction.target_error = table.maybe_real("target_error");
  plan.scattering.q_max = table.real("q_max", plan.scattering.q_max);
  plan.facet_sensitivity = table.boolean("sensitivity", false);
  const bool relaxed = table.boolean("relaxed", false);
  if (relaxed && !plan.has(MeasureKind::order)) {
    table.fail("relaxed", "is for `order`, which this [[measure]] does not take");
  }
  if (table.has("rest_time") && !relaxed) {
    table.fail("rest_time", "needs relaxed = true");
  }
  if (relaxed) {
    plan.rest = table.real("rest_time", MeasurePlan::default_rest);
  }
  return plan;
}

void read_measures(const SceneTables& tables, Scene& scene) {
  std::set<MeasureKind> taken;
  std::set<std::string> taken_outside;
  for (const SceneTable& table : tables.list("measure")) {
    const MeasurePlan plan = read_measure_plan(table, scene);
    const auto is_taken = [](const auto& wanted, auto& before) {
      return std::ranges::any_of(wanted, [&](const auto& measure) { return !before.insert(measure).second; });
    };
    if (is_taken(plan.kinds, taken) || is_taken(plan.outside, taken_outside)) {
      table.fail("what", "names a measure that another [[measure]] takes already; each has one set of tables");
    }
    scene.measures.push_back({plan, read_interval(table)});
  }
}

void read_templates(const SceneTables& tables, Scene& scene, bool must_exist) {
  std::set<std::string> names;
  for (const SceneTable& table : tables.list("template")) {
    scene.templates.push_back(read_template(table, {scene.path.parent_path(), must_exist}));
    const std::string& name = scene.templates.back().name;
    if (name.empty() || !names.insert(name).second) {
      table.fail("name", "must be a text that no other template has");
    }
  }
}

/// The contact law and the values of its parameters; parameters of other laws are refused.
void read_contact_law(const SceneTable& table, Material& material) {
  const std::string usual = table.has(HertzLaw::modulus_parameter.name) ? HertzLaw::name : ContactLaw::name;
  material.contact = table.text("contact", usual);
  const std::string k3 = ContactLaw::k3_parameter.name;
  if (material.contact != ContactLaw::name && table.has(k3)) {
    table.fail(k3, fmt::format("belongs to contact = \"{}\"; this is \"{}\"", ContactLaw::name, material.contact));
  }
  material.k3 = table.real(k3, material.k3);
  for (const ContactLawEntry& law : contact_laws()) {
    for (const Parameter& parameter : law.parameters) {
      const bool has_default = parameter.usual >= parameter.lowest && parameter.usual <= parameter.highest;
      if (law.name != material.contact && table.has(parameter.name)) {
        table.fail(parameter.name,
                   fmt::format("belongs to contact = \"{}\"; this is \"{}\"", law.name, material.contact));
      }
      if (law.name == material.contact) {
        if (!table.has(parameter.name) && !has_default) {
          table.fail("contact", fmt::format("needs {} ({}) beside it", parameter.name, parameter.unit));
        }
        material.contact_parameters.push_back(table.real(parameter.name, parameter.usual));
      }
    }
  }
}

/// Hertz's law is for two whole spheres, not for nodes of a network.
void check_contact_law(const SceneTables& tables, const Scene& scene) {
  // With files make_start looks at the grains.
  if (!contact_law_of(scene.material).for_spheres || tables.present.at("start")) {
    return;
  }
  const bool spheres =
      !scene.templates.empty() && std::all_of(scene.templates.begin(), scene.templates.end(),
                                              [](const SceneTemplate& t) { return is_single_node(t.spec); });
  if (!spheres) {
    const SceneTable& table = tables.table("material");
    const std::string key = contact_law_of(scene.material).parameters.front().name;
    table.fail(key, "is for spheres of one node: every [[template]] needs nodes = 1");
  }
}

int template_of_species(const SceneTable& table, const Scene& scene) {
  std::vector<std::string> names;
  for (const SceneTemplate& t : scene.templates) {
    names.push_back(t.name);
  }
  if (names.empty()) {
    table.fail("template", "names nothing: the scene has no [[template]]");
  }
  if (!table.has("template")) {
    if (names.size() > 1) {
      table.fail("template", "is missing; the scene has more than one template");
    }
    return 0;
  }
  const std::string wanted = table.text("template", "");
  const auto at = std::find(names.begin(), names.end(), wanted);
  if (at == names.end()) {
    table.fail("template",
               fmt::format("there is no such [[template]]; the scene has \"{}\"", fmt::join(names, "\", \"")));
  }
  return static_cast<int>(at - names.begin());
}

void read_species(const SceneTables& tables, Scene& scene) {
  for (const SceneTable& table : tables.list("species")) {
    SceneSpecies species;
    species.name = table.text("name", fmt::format("species {}", scene.species.size()));
    species.template_index = template_of_species(table, scene);
    species.count = table.integer("count", 0);
    species.material = read_alpha(table, true);
    species.breaking = read_breaking(table);
    species.yielding = read_yielding(table);
    if ((species.breaking.is_possible() || species.yielding.is_possible()) &&
        scene.templates[species.template_index].spec.shape == TemplateSpec::Shape::periodic_box) {
      table.fail(species.breaking.is_possible() ? "break_strain" : "yield_strain",
                 "is not for a periodic_box: bonds across the cell's boundary neither break nor yield");
    }
    read_sizes(table, scene, species);
    scene.species.push_back(species);
  }
  drop_replaced_templates(scene);
}

/// A copy that rests begins with whole bonds.
void check_rests(const Scene& scene) {
  const bool some_break = std::ranges::any_of(
      scene.species, [](const SceneSpecies& s) { return s.breaking.is_possible() || s.yielding.is_possible(); });
  for (const SceneMeasure& measure : scene.measures) {
    if (measure.plan.rest && some_break) {
      throw InputError(
          fmt::format("{}: measure.relaxed = true is not for grains with break_strain or yield_strain: the copy that "
                      "rests does not know what their bonds remember",
                      scene.path.string()));
    }
  }
}

/// The table that says how the scene starts, and the kind of start that it chooses.
std::pair<const SceneTable*, const StartKind*> chosen_start(const SceneTables& tables, const Scene& scene) {
  if (tables.present.at("start")) {
    for (const char* unused : {"template", "species"}) {
      if (!tables.list(unused).empty()) {
        tables.list(unused).front().fail("name", "has no use: the grains come from the files of [start]");
      }
    }
    return {&tables.table("start"), &chosen_file_start(tables.table("start"))};
  }
  const std::vector<SceneTable>& stages = tables.list("stage");
  const StartKind* start = stages.empty() ? nullptr : find_placing_start(stages.front().kind());
  if (start == nullptr) {
    std::vector<std::string> types;
    for (const StartKind& kind : start_kinds()) {
      if (!kind.is_from_files()) {
        types.push_back(kind.section.kind);
      }
    }
    throw InputError(fmt::format("{}: the first stage must be \"{}\", or the scene needs a [start] that names files",
                                 scene.path.string(), fmt::join(types, "\" or \"")));
  }
  if (scene.species.empty()) {
    throw InputError(fmt::format("{}: no [[species]]: a scene names its grains, for example "
                                 "[[species]] template = \"grain\", count = 64, alpha = 2.0",
                                 scene.path.string()));
  }
  return {&stages.front(), start};
}

void read_start(const SceneTables& tables, Scene& scene, bool must_exist) {
  const auto [table, kind] = chosen_start(tables, scene);
  scene.start = kind->read(*table, {scene.path.parent_path(), must_exist});
  scene.start->check(*table, {scene.templates, scene.species});
}

Scene read_tree(const std::string& text, const std::filesystem::path& path, const std::vector<std::string>& overrides,
                bool must_exist) {
  Scene scene;
  scene.path = path;
  scene.text = text;
  for (const std::string& assignment : overrides) {
    scene.overrides.push_back(one_line_override(assignment));
  }
  TomlNode tree = parse_toml(text, path.string());
  for (const std::string& assignment : scene.overrides) {
    apply_override(tree, assignment);
  }
  const SceneTables tables(scene_schema(), std::move(tree), path.string());
  scene.title = tables.table("").text("title", path.stem().string());
  scene.seed = static_cast<std::uint64_t>(tables.table("").integer("seed", 1));
  read_run(tables.table("run"), scene);
  scene.output = read_output(tables, path);
  const SceneTable& material = tables.table("material");
  scene.material.k = material.real("k", scene.material.k);
  scene.material.gamma = material.real("gamma", scene.material.gamma);
  if (const auto diameter = material.maybe_real(contact_diameter_parameter.name)) {
    scene.material.contact_diameter = *diameter; // absent where the scene says nothing: one law for all contacts
  }
  const std::vector<double> gravity = material.vector("gravity", {0.0, 0.0, 0.0});
  std::copy(gravity.begin(), gravity.end(), scene.material.gravity.begin());
  read_contact_law(material, scene.material);
  read_templates(tables, scene, must_exist);
  read_measures(tables, scene);
  check_contact_law(tables, scene);
  read_species(tables, scene);
  check_rests(scene);
  read_start(tables, scene, must_exist);
  scene.stages = read_stages(tables, scene);
  return scene;
}

} // namespace

Scene read_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return read_tree(read_text_file(path), path, overrides, true);
}

Scene read_stored_scene(const std::string& text, const std::filesystem::path& path,
                        const std::vector<std::string>& overrides) {
  return read_tree(text, path, overrides, false);
}

} // namespace boba
