// SPDX-License-Identifier: GPL-3.0-or-later
// What a user gets to see when something is wrong: exit codes, messages, and nothing written.
#include "tests/robustness/app/same_run.h"

#include <gtest/gtest.h>
#include <set>

namespace boba::test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CommandLine, HelpAndVersionAreNoErrors) {
  const TemporaryFolder folder;
  EXPECT_EQ(boba({"--help"}, folder).exit_code, 0);
  EXPECT_EQ(boba({"run", "--help"}, folder).exit_code, 0);
  const ProgramResult version = boba({"--version"}, folder);
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(has(version.out, "boba 0."));
}

TEST(CommandLine, UnknownWordsAreWrongInput) {
  const TemporaryFolder folder;
  EXPECT_EQ(boba({}, folder).exit_code, 2);
  EXPECT_EQ(boba({"rum"}, folder).exit_code, 2);
  EXPECT_EQ(boba({"run"}, folder).exit_code, 2);
  EXPECT_EQ(boba({"run", "scene.toml", "--wall-time", "-3"}, folder).exit_code, 2);
  EXPECT_EQ(boba({"run", "scene.toml", "--threads", "many"}, folder).exit_code, 2);
}

TEST(CommandLine, AWrongSceneWritesNothingAndNamesThePlace) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  struct Case {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::vector<Case> cases = {
      {{"run", "missing.toml"}, "missing.toml"},
      {{"run", "scene.toml", "--set", "stage.2.rate=fast"}, "stage.2.rate = \"fast\": must be a number"},
      {{"run", "scene.toml", "--set", "stage.2.ratte=1"}, "Did you mean \"rate\"?"},
      {{"run", "scene.toml", "--set", "stage.1.pressure=nan"}, "stage.1.pressure = nan"},
      {{"run", "scene.toml", "--set", "species.0.count=100000000"}, "this machine has"},
      {{"run", "scene.toml", "--set", "template.0.nodes=100000000"}, "template.0.nodes = 100000000"},
      {{"run", "scene.toml", "--set", "stage.insert.packing_fraction=0.7"}, "Allowed for these grains: at most"},
      {{"run", "scene.toml", "--set", "stage.insert.packing_fraction=1e-320"}, "from 1e-09 to 0.74"},
      {{"run", "scene.toml", "--set", "stage.2.rate=1e-320"}, "stage.2.rate = "},
      {{"run", "scene.toml", "--set", "stage.2.strain=1e6", "--set", "stage.2.rate=1e-12"},
       "steps; allowed: at most 1e+15"},
      {{"run", "scene.toml", "--set",
        "template=[{ name = \"grain\", shape = \"cylinder\", radius = 500, height = 1.1, nodes = 60 }]"},
       "height (scaled to 60 nodes)"},
      {{"run", "scene.toml", "--set", "template=[{ name = \"grain\", shape = \"box\", size = [2000, 2000, 2000] }]"},
       "number of nodes"},
      {{"run", "scene.toml", "--set", "output.directory=/tmp/elsewhere"}, "relative path"},
      {{"run", "scene.toml", "--set", "output.directory=a/../../b"}, "without \"..\""},
      {{"run", "scene.toml", "--set", "species.0={ count = 4, poisson = 0.49 }"},
       "poisson = 0.49: must be a number from -0.8 to 0.44"},
      {{"run", "scene.toml", "--set", "species.0.alpha=-1.05"},
       "species.0: alpha = -1.05: the bonded network is not stable"},
      {{"check", "scene.toml", "--set", "run.dt=0"}, "run.dt = 0"},
      {{"resume", "nowhere"}, "nowhere"},
      {{"plot", "nowhere"}, "nowhere"},
      {{"forces", "missing.data", "--alpha", "2", "--output", "f.dump"}, "missing.data"},
      {{"forces", "scene.toml", "--alpha", "2", "--output", "f.dump"}, "scene.toml"},
      {{"forces", "scene.toml", "--alpha", "nan", "--output", "f.dump"}, "--alpha"},
  };
  for (const Case& c : cases) {
    const ProgramResult result = boba(c.arguments, folder);
    EXPECT_EQ(result.exit_code, 2) << c.message << "\n" << result.err;
    EXPECT_TRUE(has(result.err, c.message)) << "\"" << c.message << "\" is missing in: " << result.err;
    int n_files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder / "")) {
      ++n_files;
    }
    EXPECT_EQ(n_files, 1) << c.message << ": something was written";
  }
}

TEST(CommandLine, ExistingOutputIsKeptWithoutForce) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  const std::vector<std::string> run{"run", "scene.toml", "--set", "stage.2.strain=0.02", "--output", "here"};
  ASSERT_EQ(boba(run, folder).exit_code, 0);
  const std::string table = content_of(folder / "here/table.csv");
  folder.file("here/notes.txt", "mine");
  const ProgramResult again = boba(run, folder);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_TRUE(has(again.err, "--force")) << again.err;
  EXPECT_EQ(content_of(folder / "here/table.csv"), table);

  std::vector<std::string> forced = run;
  forced.push_back("--force");
  EXPECT_EQ(boba(forced, folder).exit_code, 0);
  EXPECT_EQ(content_of(folder / "here/notes.txt"), "mine") << "--force removes Boba's own files only";
}

TEST(CommandLine, ABlowUpStopsWithACauseAndKeepsTheCheckpoint) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  // Bonds are stable at dt = 0.1; contacts as stiff as these are not.
  const ProgramResult result = boba({"run", "scene.toml", "--set", "material.k3=1e6"}, folder);
  EXPECT_EQ(result.exit_code, 1);
  for (const char* word : {"node", "grain", "step", "dt"}) {
    EXPECT_TRUE(has(result.err, word)) << word << " is missing in: " << result.err;
  }
  EXPECT_FALSE(std::filesystem::is_empty(folder / "out/checkpoints"));
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.insert(entry.path().filename().string());
  }
  return names;
}

/// A scene is data: its texts reach no shell, and its folder is below the current one.
TEST(CommandLine, AScenesTextsAreOnlyTexts) {
  const TemporaryFolder folder;
  const std::string trap = "$(touch trap) `touch trap`; touch trap | touch trap & %s%n";
  std::string scene = small_scene;
  scene.replace(scene.find("four small grains"), 17, trap);
  scene.replace(scene.find("name = \"grain\""), 14, "name = \"" + trap + "\"");
  scene.replace(scene.find("\"out\""), 5, "\"out $(touch trap);\"");
  folder.file("scene.toml", scene);
  const std::string out = "out $(touch trap);";
  ASSERT_EQ(boba({"run", "scene.toml", "--set", "stage.2.strain=0.01"}, folder).exit_code, 0);
  ASSERT_EQ(boba({"resume", out}, folder).exit_code, 0);
  ASSERT_EQ(boba({"measure", out, "--what", "stress"}, folder).exit_code, 0);
  EXPECT_EQ(names_in(folder / ""), (std::set<std::string>{"scene.toml", out}));
  EXPECT_FALSE(names_in(folder / out).contains("trap"));
}

TEST(CommandLine, AScenesFolderIsBelowTheCurrentOneThroughLinksToo) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  std::filesystem::create_directories(folder / "work");
  std::filesystem::create_directories(folder / "elsewhere");
  std::filesystem::create_directory_symlink(folder / "elsewhere", folder / "work/link");
  std::filesystem::copy_file(folder / "scene.toml", folder / "work/scene.toml");
  const ProgramResult result = run_program({BOBA_PROGRAM, "run", "scene.toml", "--set", "output.directory=link/out"},
                                           (folder / "work").string());
  EXPECT_EQ(result.exit_code, 2) << result.out;
  EXPECT_TRUE(has(result.err, "output.directory") && has(result.err, "--output")) << result.err;
  EXPECT_TRUE(names_in(folder / "elsewhere").empty());
}

TEST(CommandLine, AStepThatTheBondsCannotTakeIsRefusedBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  const ProgramResult result = boba({"run", "scene.toml", "--set", "run.dt=0.9"}, folder);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  for (const char* word : {"run.dt = 0.9", "alpha = 2", "auto"}) {
    EXPECT_TRUE(has(result.err, word)) << word << " is missing in: " << result.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

/// The number that "auto" stands for is kept: the run, what is made of it later and a resumed run share one step.
TEST(CommandLine, AnAutomaticStepIsARememberedNumber) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  const std::vector<std::string> run{"run", "scene.toml", "--set", "run.dt=auto", "--set", "stage.2.strain=0.1"};
  const ProgramResult result = boba(run, folder);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string scene = content_of(folder / "out/scene.toml");
  const std::size_t at = scene.find("# --set run.dt=0.");
  ASSERT_NE(at, std::string::npos) << scene;
  const std::string number = scene.substr(at + 15, scene.find('\n', at) - at - 15);
  EXPECT_GT(std::stod(number), 0.05);
  EXPECT_LT(std::stod(number), 0.2);
  std::vector<std::string> again{"run",   "scene.toml",         "--set",    "run.dt=" + number,
                                 "--set", "stage.2.strain=0.1", "--output", "again"};
  ASSERT_EQ(boba(again, folder).exit_code, 0);
  expect_same_run(folder / "out", folder / "again");
  std::vector<std::string> cut = run;
  cut.insert(cut.end(), {"--output", "cut", "--wall-time", "0.03"});
  ASSERT_EQ(boba(cut, folder).exit_code, 75);
  ASSERT_EQ(boba({"resume", "cut"}, folder).exit_code, 0);
  expect_same_run(folder / "out", folder / "cut");
}

TEST(CommandLine, CheckSaysWhatWouldRunAndFailsAnUnstableStep) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  const ProgramResult good = boba({"check", "scene.toml"}, folder);
  EXPECT_EQ(good.exit_code, 0) << good.err;
  for (const char* word :
       {"240 nodes", "4 grains", "bytes a node", "stage.2 shear: 5000 steps", "lanes filled: 50 %", "skipped:"}) {
    EXPECT_TRUE(has(good.out, word)) << word << " is missing in: " << good.out;
  }
  EXPECT_EQ(boba({"check", "scene.toml", "--set", "run.dt=0.9"}, folder).exit_code, 3);
}

TEST(CommandLine, OtherProgramsAreStartedOrNamed) {
  const TemporaryFolder folder;
  for (const char* name : {"continuum", "calibrate"}) {
    const ProgramResult result = boba({name, "--help"}, folder);
    const bool named = result.exit_code == 1 && has(result.err, std::string("boba-") + name);
    EXPECT_TRUE(result.exit_code == 0 || named) << name << ": " << result.exit_code << " " << result.err;
  }
}

TEST(CommandLine, PlotsATable) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  ASSERT_EQ(boba({"run", "scene.toml", "--set", "stage.2.strain=0.05"}, folder).exit_code, 0);
  const ProgramResult plot = boba({"plot", "out"}, folder);
  EXPECT_EQ(plot.exit_code, 0) << plot.err;
  EXPECT_TRUE(content_of(folder / "out/plot.png").starts_with("\x89PNG"));
}

} // namespace
} // namespace boba::test
