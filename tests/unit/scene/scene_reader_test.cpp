// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/scene/scene.h"
#include "bpm/scene/scene_schema.h"
#include "bpm/scene/scene_stages.h"
#include "bpm/stages/compress.h"
#include "bpm/stages/insert.h"
#include "bpm/stages/shear.h"
#include "bpm/stages/specimen.h"

#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace boba {
namespace {

const std::string shear_scene = R"(title = "a shear"
seed = 7

[run]
dt = 0.05
threads = 2

[output]
directory = "out/here"

[output.trajectory]
every_strain = 0.1
velocities = true

[[template]]
name = "small"
nodes = 300

[[template]]
name = "rod"
shape = "cylinder"
radius = 3
height = 9.5

[[species]]
template = "small"
count = 60
alpha = 2.0

[[species]]
template = "rod"
count = 4
poisson = -0.25

[[stage]]
type = "insert"
packing_fraction = 0.3

[[stage]]
type = "compress"
normalised_pressure = 0.1

[[stage]]
type = "shear"
rate = -1e-3
strain = 1
pressure = 0.2
gain = 0.02
remap = "velocities"
)";

Scene read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read_stored_scene(text, "scene.toml", overrides);
}

TEST(SceneReader, ReadsEveryPart) {
  const Scene scene = read(shear_scene);
  EXPECT_EQ(scene.title, "a shear");
  EXPECT_EQ(scene.seed, 7U);
  EXPECT_DOUBLE_EQ(scene.options.dt, 0.05);
  EXPECT_EQ(scene.options.threads, 2);
  EXPECT_EQ(scene.output.directory, "out/here");
  ASSERT_TRUE(scene.output.trajectory);
  EXPECT_TRUE(scene.output.trajectory->velocities);
  EXPECT_DOUBLE_EQ(*scene.output.trajectory->every.strain, 0.1);
  EXPECT_FALSE(scene.output.dump);
  ASSERT_EQ(scene.templates.size(), 2U);
  EXPECT_EQ(scene.templates[0].spec.n_nodes, 300);
  EXPECT_EQ(scene.templates[1].spec.shape, TemplateSpec::Shape::cylinder);
  EXPECT_DOUBLE_EQ(scene.templates[1].spec.height, 9.5);
  ASSERT_EQ(scene.species.size(), 2U);
  EXPECT_EQ(scene.species[1].template_index, 1);
  EXPECT_DOUBLE_EQ(*scene.species[1].material.poisson, -0.25);
  EXPECT_DOUBLE_EQ(dynamic_cast<const InsertStart&>(*scene.start).packing_fraction(), 0.3);
  ASSERT_EQ(scene.stages.size(), 2U);
  EXPECT_EQ(scene.stages[0].index, 1);
  const Packing packing;
  StageContext context = stage_context(scene, packing, 3.0);
  const auto& compress = dynamic_cast<const CompressEntry&>(*scene.stages[0].entry);
  EXPECT_DOUBLE_EQ(compress.pressure().barostat(context)->pressure, 0.1 * 3.0);
  context.numbers.modulus.reset();
  EXPECT_THROW(prepare_stages(scene, context), InputError);
  const auto& entry = dynamic_cast<const ShearEntry&>(*scene.stages[1].entry);
  const ShearStage& shear = entry.parameters();
  EXPECT_DOUBLE_EQ(shear.rate, -1e-3);
  EXPECT_EQ(shear.remap, Remap::velocities);
  const std::optional<Barostat> barostat = entry.pressure().barostat(context);
  ASSERT_TRUE(barostat);
  EXPECT_DOUBLE_EQ(barostat->pressure, 0.2);
  EXPECT_DOUBLE_EQ(*barostat->gain, 0.02);
}

TEST(SceneReader, OverridesReplaceAndAdd) {
  const Scene scene = read(shear_scene, {"stage.1.rate=1e-4", "stage.shear.strain=3", "run.skin=0.5",
                                         "title=plain words", "output.dump.every_time=10", "species.0.count=5"});
  EXPECT_DOUBLE_EQ(dynamic_cast<const CompressEntry&>(*scene.stages[0].entry).parameters().rate, 1e-4);
  EXPECT_DOUBLE_EQ(dynamic_cast<const ShearEntry&>(*scene.stages[1].entry).parameters().strain, 3.0);
  EXPECT_DOUBLE_EQ(scene.options.skin, 0.5);
  EXPECT_EQ(scene.title, "plain words");
  EXPECT_DOUBLE_EQ(*scene.output.dump->every.time, 10.0);
  EXPECT_EQ(scene.species[0].count, 5);
}

TEST(SceneReader, LaterOverrideWins) {
  EXPECT_DOUBLE_EQ(read(shear_scene, {"run.dt=0.02", "run.dt=0.03"}).options.dt, 0.03);
}

std::string message_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read(text, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = shear_scene;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The scene with one mistake and words that its message must hold.
struct Mistake {
  std::string from, to;
  std::vector<std::string> words;
};

TEST(SceneReader, NamesFileLineKeyValueAndWhatIsAllowed) {
  const std::vector<Mistake> mistakes = {
      {"dt = 0.05", "dt = \"fast\"", {"scene.toml:5:", "run.dt", "\"fast\"", "a number above 0", "tau"}},
      {"dt = 0.05", "dt = nan", {"scene.toml:5:", "run.dt = nan", "at most 1"}},
      {"dt = 0.05", "dt = inf", {"run.dt = inf", "at most 1"}},
      {"dt = 0.05", "dt = 0", {"run.dt = 0", "above 0"}},
      {"dt = 0.05", "dt = 1e300", {"run.dt = 1e+300", "at most 1"}},
      {"dt = 0.05", "td = 0.05", {"scene.toml:5:", "run.td = 0.05", "no such key", "dt, threads"}},
      {"threads = 2", "thread = 2", {"Did you mean \"threads\"?"}},
      {"threads = 2", "threads = 2.5", {"scene.toml:6:", "a whole number from 0 to 1024"}},
      {"threads = 2", "threads = 99999999999999999999", {"scene.toml:6:"}},
      {"[run]", "[runs]", {"scene.toml:4:", "runs", "Did you mean \"run\"?"}},
      {"[run]", "[[run]]", {"scene.toml:4:", "must be a table, [run]"}},
      {"directory = \"out/here\"", "directory = \"../x\"", {"scene.toml:9:", "without \"..\""}},
      {"directory = \"out/here\"", "directory = \"/etc\"", {"relative path"}},
      {"velocities = true", "velocities = 1", {"scene.toml:13:", "true or false"}},
      {"nodes = 300", "nodes = 0", {"template.0.nodes", "from 1"}},
      {"nodes = 300", "nodes = 300000000000", {"template.0.nodes", "whole number"}},
      {"nodes = 300", "nodes = 300\nheight = 3", {"template.0.height", "belongs to a cylinder"}},
      {"radius = 3", "radius = -3", {"template.1.radius", "above 0.5"}},
      {"shape = \"cylinder\"", "shape = \"cylindre\"", {"template.1.shape", "\"sphere\", \"cylinder\""}},
      {"shape = \"cylinder\"", "shape = \"ellipsoid\"", {"template.1.radius", "not to an ellipsoid"}},
      {"shape = \"cylinder\"", "shape = \"capsule\"\nsize = [3, 3, 3]", {"template.1.size", "or a superellipsoid"}},
      {"shape = \"cylinder\"", "shape = \"polyhedron\"\npolyhedron = \"cub\"", {"template.1.polyhedron", "\"cube\""}},
      {"shape = \"cylinder\"", "shape = \"polyhedron\"\nvertices = [[0, 0, 0]]", {"4 to 100 points [x, y, z]"}},
      {"shape = \"cylinder\"", "shape = \"mesh\"\nfile = \"no.stl\"", {"template.1.", "mesh"}},
      {"name = \"rod\"", "name = \"small\"", {"template.1.name", "no other template"}},
      {"template = \"rod\"", "template = \"rods\"", {"species.1.template", "\"small\", \"rod\""}},
      {"count = 60", "count = -1", {"species.0.count = -1", "from 1"}},
      {"alpha = 2.0", "alpha = -3", {"species.0.alpha", "above -1.1"}},
      {"alpha = 2.0", "alpha = 2.0\npoisson = 0", {"species.0.poisson", "one of them"}},
      {"alpha = 2.0", "", {"species.0.alpha", "is missing"}},
      {"poisson = -0.25", "poisson = 0.4401", {"species.1.poisson", "to 0.44"}},
      {"type = \"insert\"", "type = \"inset\"", {"stage.0.type", "Did you mean \"insert\"?"}},
      {"type = \"insert\"\npacking_fraction = 0.3", "type = \"hold\"\ntime = 3.0", {"\"insert\" or \"specimen\""}},
      {"packing_fraction = 0.3", "packing_fraction = 0.9", {"stage.0.packing_fraction", "from 1e-09 to 0.74"}},
      {"normalised_pressure = 0.1", "", {"stage.1.pressure", "must be given"}},
      {"normalised_pressure = 0.1", "normalised_pressure = 0.1\npressure = 1.0", {"stage.1", "one of them"}},
      {"rate = -1e-3", "", {"stage.2.rate is missing", "a number from -0.1 to 0.1 (1/tau)"}},
      {"rate = -1e-3", "rate = 0", {"stage.2.rate = 0", "must not be 0"}},
      {"pressure = 0.2\n", "", {"stage.2.gain", "needs pressure"}},
      {"remap = \"velocities\"", "remap = true", {"stage.2.remap = true", "\"positions\", \"velocities\""}},
      {"remap = \"velocities\"", "[[stage]]\ntype = \"insert\"", {"stage.3.type", "first stage"}},
      {"remap = \"velocities\"", "[[stage]]\ntype = \"press\"\nstrain = 0.1", {"stage.3.type", "open cell"}},
      {"remap = \"velocities\"", "[[stage]]\nstrain = 0.1", {"stage.3.type is missing"}},
      {"seed = 7", "seed = -7", {"scene.toml:2:", "seed = -7", "from 0"}},
      {"seed = 7", "seed = 7\nseed = 8", {"scene.toml:3:"}},
      {"seed = 7", "seed = ", {"scene.toml:2:"}},
      {"seed = 7", "seed = 1979-05-27", {"scene.toml:2:", "a whole number"}},
      {"seed = 7", "stage = 3", {"stage"}},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string message = message_of(replaced(mistake.from, mistake.to));
    EXPECT_NE(message, "") << mistake.to << " was accepted";
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& word : mistake.words) {
      EXPECT_NE(message.find(word), std::string::npos) << "\"" << word << "\" is missing in: " << message;
    }
  }
}

TEST(SceneReader, NamesTheOverride) {
  const std::vector<Mistake> mistakes = {
      {"stage.2.rate=fast", "", {"--set stage.2.rate=fast:", "stage.2.rate = \"fast\"", "a number"}},
      {"stage.2.rat=1", "", {"--set stage.2.rat=1:", "Did you mean \"rate\"?"}},
      {"stage.9.rate=1", "", {"--set stage.9.rate=1:", "stage.0 to stage.2"}},
      {"stage.hold.time=1", "", {"there is no stage.hold"}},
      {"run.dt", "", {"--set run.dt:", "section.key=value"}},
      {"run.dt=", "", {"section.key=value"}},
      {"=3", "", {"section.key=value"}},
      {"run..dt=3", "", {"section.key=value"}},
      {"run.dt.x=3", "", {"run.dt is 0.05"}},
      {"rum.dt=3", "", {"Did you mean \"run\"?"}},
      {"run=3", "", {"--set run=3:", "must be a table"}},
  };
  for (const Mistake& mistake : mistakes) {
    const std::string message = message_of(shear_scene, {mistake.from});
    EXPECT_NE(message, "") << mistake.from << " was accepted";
    for (const std::string& word : mistake.words) {
      EXPECT_NE(message.find(word), std::string::npos) << "\"" << word << "\" is missing in: " << message;
    }
  }
}

TEST(SceneReader, MissingFilesAreNamed) {
  EXPECT_THROW(read_scene("/nowhere/scene.toml", {}), InputError);
  EXPECT_THROW(read_scene("/dev/zero", {}), InputError);
  EXPECT_THROW(read_scene("/", {}), InputError);
  const std::string path = testing::TempDir() + "/from_files.toml";
  std::ofstream(path) << "[start]\nlammps_reference = \"missing.data\"\n[[stage]]\ntype = \"hold\"\ntime = 1\n";
  try {
    read_scene(path, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("from_files.toml:2: start.lammps_reference"), std::string::npos)
        << error.what();
  }
}

TEST(SceneReader, SpecimenNeedsOneGrainAndAnOpenCell) {
  const std::string scene =
      "[[template]]\nname = \"rod\"\nshape = \"cylinder\"\n[[species]]\ncount = 1\nalpha = 0\n"
      "[[stage]]\ntype = \"specimen\"\n[[stage]]\ntype = \"press\"\nstrain = 0.05\nends = \"clamps\"\n"
      "velocity = -1e-3\n";
  EXPECT_NE(dynamic_cast<const SpecimenStart*>(read(scene).start.get()), nullptr);
  EXPECT_NE(message_of(scene, {"species.0.count=2"}).find("count = 1"), std::string::npos);
  EXPECT_NE(message_of(scene, {"template.0.shape=periodic_box"}).find("open cell"), std::string::npos);
  EXPECT_NE(message_of(scene, {"stage.1.velocity=0"}).find("must not be 0"), std::string::npos);
}

TEST(SceneReader, HertzHasNoWallsAndNoClamps) {
  const std::string scene =
      "[material]\nhertz_modulus = 0.1\n[[template]]\nname = \"point\"\nnodes = 1\n[[species]]\ncount = 1\n"
      "alpha = 0\n[[stage]]\ntype = \"specimen\"\n[[stage]]\ntype = \"press\"\nstrain = 0.05\n";
  EXPECT_NE(message_of(scene).find("stage.1.type = \"press\": has no meaning with material.hertz_modulus"),
            std::string::npos)
      << message_of(scene);
  EXPECT_EQ(message_of(scene, {"stage.1={type = \"hold\", time = 1.0}"}), "");
}

TEST(SceneReader, EveryKeyRefusesEveryOtherType) {
  // Each key of each table gets a value of every wrong type; each must be refused by name.
  for (const SceneSection& section : scene_schema()) {
    for (const SceneKey& key : section.keys) {
      for (const char* value :
           {"{ x = 1 }", "[[1]]", "1979-05-27", "nan", "1e300", "-1e300", "\"\\u0000\"", "true", "[1, nan, 2]"}) {
        const bool fits = (key.type == SceneKey::Type::boolean && std::string(value) == "true") ||
                          (key.type == SceneKey::Type::text && value[0] == '"');
        if (fits) {
          continue;
        }
        const std::string kind = section.kind.empty() ? "" : "type = \"" + section.kind + "\"\n";
        const std::string holder = section.path == "species.size" ? "[[species]]\ncount = 1\n" : "";
        const std::string brackets =
            holder + (section.repeated ? "[[" + section.path + "]]\n" : "[" + section.path + "]\n");
        const std::string text = (section.path.empty() ? "" : brackets + kind) + key.name + " = " + value + "\n";
        const std::string message = message_of(text);
        EXPECT_NE(message.find(key.name), std::string::npos) << text << message;
        EXPECT_NE(message.find("scene.toml:"), std::string::npos) << text << message;
        EXPECT_NE(message.find("must be " + key.allowed()), std::string::npos) << text << message;
      }
    }
  }
}

TEST(SceneReference, IsWhatTheRepositoryHolds) {
  std::ifstream file(BOBA_SOURCE_DIR "/docs/scene.md");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), scene_reference()) << "write it again: boba info --scene-reference > docs/scene.md";
}

TEST(NearestWord, FindsSlipsAndLeavesStrangersAlone) {
  const std::vector<std::string> known{"rate", "strain", "pressure", "normalised_pressure"};
  EXPECT_EQ(nearest_word("rat", known), "rate");
  EXPECT_EQ(nearest_word("presure", known), "pressure");
  EXPECT_EQ(nearest_word("normalized_pressure", known), "normalised_pressure");
  EXPECT_EQ(nearest_word("qwxyz", known), "");
  EXPECT_EQ(nearest_word(std::string(100000, 'x'), known), "");
}

} // namespace
} // namespace boba
