// SPDX-License-Identifier: GPL-3.0-or-later
// The scene format, as a table. Nothing else in the program lists its keys.
#include "bpm/scene/scene_schema.h"

#include "bpm/forces/contact_laws.h"
#include "bpm/grain/shapes/convex_polyhedron.h"
#include "bpm/grain/shapes/shape.h"
#include "bpm/scene/read_sizes.h"
#include "bpm/stages/stage_registry.h"
#include "bpm/stages/start_registry.h"

#include <fmt/format.h>
#include <list>
#include <sstream>

namespace boba {

namespace {

constexpr double most_nodes = 2e8;
constexpr double largest_seed = 9007199254740992.0; // 2^53: survives a trip through a double

std::vector<SceneKey> interval_keys(const std::string& what, const std::string& time_fallback,
                                    const std::string& strain_fallback) {
  return {
      above_key("every_strain", "", 0.0, 1e3, strain_fallback,
                what + " whenever the shear strain has grown by this much"),
      above_key("every_time", "tau", 0.0, 1e12, time_fallback, what + " whenever this much time has passed"),
  };
}

SceneSection section(std::string path, std::string doc, std::vector<SceneKey> keys) {
  return {std::move(path), "", false, std::move(doc), std::move(keys)};
}

SceneSection repeated(std::string path, std::string doc, std::vector<SceneKey> keys) {
  return {std::move(path), "", true, std::move(doc), std::move(keys)};
}

std::vector<SceneSection> general_sections() {
  return {
      section("", "",
              {text_key("title", "", "what the scene is; copied into the results"),
               integer_key("seed", 0.0, largest_seed, "1", "placement and rotation of the grains")}),
      section("run", "How the run is computed.",
              {or_text(above_key("dt", "tau", 0.0, 1.0, "0.1",
                                 "time step; \"auto\" takes 0.6 of the largest step at which the grains' bonds are "
                                 "stable (docs/stability.md). A step beyond that is refused"),
                       {"auto"}),
               integer_key("threads", 0.0, 1024.0, "0", "threads; 0 takes all cores. The result does not depend on it"),
               choice_key("precision", {"double", "mixed"}, "\"double\"",
                          "mixed: positions in 32-bit fixed point from their grain's centre, the rest in floats; "
                          "faster, with forces to six or seven digits"),
               real_key("skin", "d", 0.02, 2.0, "0.3",
                        "margin of the contact list; the result does not depend on it "
                        "beyond rounding"),
               above_key("wall_time", "s", 0.0, 1e9, "", "stop with a checkpoint (exit code 75) after this long")}),
      section("output",
              "What is written besides the table, the log and the checkpoints. `--output DIR` replaces `directory`.",
              {text_key("directory", "out/NAME of the scene file",
                        "output folder below the current one: a relative path without `..`")}),
      section("output.table", "Rows of table.csv; one more at the beginning and the end of every stage.",
              interval_keys("a row", "100", "0.01")),
      section("output.trajectory",
              "trajectory.h5 (H5MD): written when this table exists. Frames at the beginning and the end of every "
              "stage, and:",
              joined(interval_keys("a frame", "", ""),
                     {boolean_key("velocities", "false", "store the nodes' velocities too")})),
      section("output.dump", "dump.lammpstrj for OVITO: written when this table exists; frames as for the trajectory.",
              joined(interval_keys("a frame", "", ""),
                     {boolean_key("velocities", "false", "store the nodes' velocities too")})),
      section("output.vtk",
              "vtk/packing.pvd for ParaView: written when this table exists; frames as for the trajectory.",
              interval_keys("a frame", "", "")),
      section(
          "output.checkpoint",
          "The last two checkpoints are kept; one is written at the end and when the run is stopped.",
          {above_key("every_seconds", "s", 0.0, 1e9, "600",
                     "a checkpoint whenever so many seconds of real time have passed"),
           above_key("every_time", "tau", 0.0, 1e12, "", "a checkpoint whenever this much simulated time has passed")}),
      repeated(
          "measure",
          "Measures taken while the run goes, into the tables of the folder `measures` (docs/formats-measure.md): at "
          "the beginning and the end of every stage, and:",
          joined(interval_keys("a measurement", "", ""),
                 {required(text_key("what", "",
                                    "all, or some of stress, packing-fraction, shape, scattering, order, "
                                    "contacts, motion, separated by commas; each in one `[[measure]]` only")),
                  integer_key("points", 1.0, 1e9, "100000", "random points of the packing fraction"),
                  real_key("target_error", "", 1e-5, 0.5, "",
                           "draw points until the packing fraction's standard error is at most this"),
                  above_key("q_max", "1/d", 0.0, 20.0, "1", "scattering: largest wave number"),
                  choice_key("neighbours", {"solid-angle", "voronoi"}, "\"solid-angle\"",
                             "rule for neighbours of order and motion"),
                  boolean_key("relaxed", "false",
                              "order of a copy after a short rest in its cell; the run itself does not change"),
                  above_key("rest_time", "tau", 0.0, 1e6, "100", "time of that rest"),
                  boolean_key("sensitivity", "false", "count facets at other thresholds too")})),
  };
}

SceneKey parameter_key(const Parameter& p) {
  const bool has_default = p.usual >= p.lowest && p.usual <= p.highest;
  SceneKey key =
      real_key(p.name, p.unit, p.lowest, p.highest, has_default ? fmt::format("{:g}", p.usual) : "", p.meaning);
  key.above_lowest = p.above_lowest;
  return key;
}

/// Which contact law, and the parameters of each.
std::vector<SceneKey> contact_law_keys() {
  std::vector<std::string> names;
  std::vector<SceneKey> parameters = {parameter_key(ContactLaw::k3_parameter)};
  for (const ContactLawEntry& law : contact_laws()) {
    names.push_back(law.name);
    for (const Parameter& parameter : law.parameters) {
      parameters.push_back(parameter_key(parameter));
    }
  }
  return joined({choice_key("contact", names, "\"hookean\"",
                            "law of the contacts between nodes, and between nodes and walls (docs/notation.md); a key "
                            "of the law \"hertz\" chooses it too")},
                parameters);
}

SceneKey gravity_key() {
  SceneKey key = real_key("gravity", "d/tau^2", -0.1, 0.1, "[0, 0, 0]",
                          "acceleration of every node; only along axes along which the cell is open");
  key.type = SceneKey::Type::vector3;
  return key;
}

std::vector<SceneSection> material_sections() {
  return {
      section("material", "Constants that all grains share.",
              joined({parameter_key(BondLaw::k_parameter), parameter_key(BondLaw::gamma_parameter),
                      parameter_key(contact_diameter_parameter), gravity_key()},
                     contact_law_keys())),
      repeated("template",
               "An undeformed grain. Built once, then read from the cache (`~/.cache/boba`, or BOBA_CACHE_DIR).",
               {required(text_key("name", "", "what [[species]] calls it")),
                choice_key("shape", shape_names(), "\"sphere\"", "its shape"),
                above_key("radius", "d", 0.5, 500.0, "10",
                          "of a sphere, cylinder or capsule, or of the sphere through the corners of a polyhedron; a "
                          "grain has 20 nodes at least, which is a sphere's radius of 1.58"),
                above_key("height", "d", 1.0, 2000.0, "40",
                          "of a cylinder (along z), or of a capsule with both half spheres"),
                vector_key("size", "d", 1.0, 2000.0, "[20, 20, 20]",
                           "edges of a box, or diameters of an ellipsoid or superellipsoid"),
                real_key("exponent", "", 1.0, 50.0, "4",
                         "e of a superellipsoid (|x/a|^e + |y/b|^e)^(f/e) + |z/c|^f = 1: 2 is round, 1 an octahedron, "
                         "large a box"),
                real_key("exponent_z", "", 1.0, 50.0, "that of exponent", "f of a superellipsoid"),
                choice_key("polyhedron", polyhedron_names(), "\"cube\"", "which polyhedron"),
                vectors_key("vertices", "d", -1e4, 1e4, 4, ConvexPolyhedron::most_vertices,
                            "corners of a convex polyhedron, in place of its name and radius"),
                real_key("rounding", "", 0.0, 0.9, "0",
                         "radius of a polyhedron's rounded edges over that of the sphere inside"),
                text_key("file", "",
                         "of a mesh: a closed surface of triangles in STL, OFF, PLY or OBJ, normals outwards, told by "
                         "the name's ending"),
                above_key("scale", "d", 0.0, 1e6, "1", "unit of the mesh's coordinates"),
                integer_key("nodes", 1.0, 2e7, "",
                            "scale the shape so that it holds this many nodes: 20 and more, or 1, a rigid sphere of "
                            "diameter d"),
                choice_key("surface", {"cut", "wall"}, "\"cut\"",
                           "cut from a bulk arrangement, or relaxed inside a smooth wall"),
                integer_key("seed", 0.0, largest_seed, "1", "of the arrangement")}),
      repeated("species", "So many grains of a template with one Poisson's ratio.",
               joined({text_key("name", "", "for messages and tables"),
                       text_key("template", "the only one", "name of a [[template]]"),
                       required(integer_key("count", 1.0, most_nodes, "", "number of grains"))},
                      joined(alpha_keys(true), bond_keys()))),
      section("species.size",
              "Grains of several sizes, inside a `[[species]]`: `size = { distribution = \"normal\", spread = 0.1 }`. "
              "The template's own size is 1. Grains are dealt out as near to the shares as whole numbers allow; what "
              "came of it is told. Rules: docs/how-to/shapes.md.",
              size_keys()),
      start_section(),
  };
}

/// What every kind of start and stage says of itself.
std::vector<SceneSection> stage_sections() {
  std::vector<SceneSection> sections;
  for (const StartKind& start : start_kinds()) {
    if (!start.is_from_files()) {
      sections.push_back(start.section);
    }
  }
  for (const StageKind& stage : stage_kinds()) {
    sections.push_back(stage.section);
    sections.back().keys.push_back(
        text_key("name", "", "its name in `--set stage.NAME.key=value` and in the log; no other stage has it"));
    sections.back().keys.push_back(boolean_key(
        "strict", "false", "end the run with exit code 3 when the stage misses a pressure or a stress that it holds"));
  }
  return sections;
}

} // namespace

const std::vector<SceneSection>& scene_schema() {
  // A stage may be registered after the schema was first used: tables point into the older one.
  static std::list<std::vector<SceneSection>> made;
  static std::size_t n_kinds = 0;
  if (made.empty() || n_kinds != stage_kinds().size() + start_kinds().size()) {
    n_kinds = stage_kinds().size() + start_kinds().size();
    std::vector<SceneSection>& all = made.emplace_back(general_sections());
    for (const std::vector<SceneSection>& part : {material_sections(), stage_sections()}) {
      all.insert(all.end(), part.begin(), part.end());
    }
  }
  return made.back();
}

namespace {

/// A vertical bar would end the cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += c == '|' ? std::string("\\|") : std::string(1, c);
  }
  return result;
}

/// The same words in lines of at most 118 columns.
std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string result;
  std::size_t column = 0;
  for (std::string word; words >> word;) {
    if (column > 0 && column + 1 + word.size() > 118) {
      result += '\n';
      column = 0;
    }
    result += column > 0 ? " " + word : word;
    column += word.size() + (column > 0 ? 1 : 0);
  }
  return result;
}

} // namespace

std::string scene_reference() {
  std::string text =
      "# The scene format\n\n"
      "This page is written by `boba info --scene-reference`; do not edit it.\n\n"
      "A scene is a [TOML](https://toml.io) file. Units: node diameter d, node mass m, bond stiffness k are 1; time\n"
      "tau = sqrt(m/k), pressure k/d, alpha k d (docs/notation.md). A key or a table that is not listed here, a value "
      "of\n"
      "another type or outside its range stops the program with exit code 2 before anything is written.\n\n"
      "`--set PLACE=VALUE` on the command line replaces a value or adds one: `--set run.dt=0.05`,\n"
      "`--set stage.1.rate=1e-4` (entries of `[[stage]]`, `[[template]]` and `[[species]]` count from 0) or\n"
      "`--set stage.shear.rate=1e-4` (the only stage of that type, or the one with that `name`).\n\n"
      "Paths of input files are relative to the scene's folder. Nothing is written outside the output folder.\n";
  for (const SceneSection& section : scene_schema()) {
    const std::string brackets =
        section.repeated ? fmt::format("[[{}]]", section.path) : fmt::format("[{}]", section.path);
    const std::string name = section.path.empty() ? "Top of the file" : "`" + brackets + "`";
    text += fmt::format("\n## {}{}\n", name, section.kind.empty() ? "" : " `type = \"" + section.kind + "\"`");
    if (!section.doc.empty()) {
      text += "\n" + wrapped(section.doc) + "\n";
    }
    if (!section.keys.empty()) {
      text += "\n| key | allowed | default | meaning |\n| --- | --- | --- | --- |\n";
    }
    for (const SceneKey& key : section.keys) {
      const std::string fallback =
          key.required ? "required" : (key.fallback.empty() ? "none" : "`" + key.fallback + "`");
      text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, key.allowed(), fallback, cell(key.doc));
    }
  }
  return text;
}

} // namespace boba
