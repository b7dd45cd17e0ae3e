// SPDX-License-Identifier: GPL-3.0-or-later
// Measures under mpirun: the same tables to the last bit, measured along a run or on its stored frames.
#include "tests/parallel/program_on_ranks.h"
#include "tests/robustness/app/small_scene.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

/// Every kind of measure, with every table: ten grains, so that ranks have different numbers of them.
std::vector<std::string> run_into(const std::string& output, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"run", "scene.toml", "--output", output, "--quiet", "--set", "species.0.count=10"};
  for (const char* assignment :
       {"stage.0.packing_fraction=0.3", "stage.1.rate=2e-2", "stage.1.pressure_tolerance=0.1",
        "stage.1.kinetic_tolerance=0.2", "stage.2.rate=1e-2", "stage.2.strain=0.1",
        ("measure=[{what = \"stress, packing-fraction, shape, scattering, contacts\", every_strain = 0.04, q_max = "
         "2.0, "
         "points = 20000, sensitivity = true}, {what = \"order, motion\", every_strain = 0.03, neighbours = "
         "\"voronoi\"}]")}) {
    arguments.insert(arguments.end(), {"--set", assignment});
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

constexpr int n_tables = 15;

void expect_same_tables(const std::filesystem::path& a, const std::filesystem::path& b, int n_files) {
  int n = 0;
  for (const auto& entry : std::filesystem::directory_iterator(a)) {
    const std::string expected = content_of(entry.path());
    EXPECT_GT(std::count(expected.begin(), expected.end(), '\n'), 2) << entry.path();
    EXPECT_TRUE(content_of(b / entry.path().filename()) == expected) << b / entry.path().filename() << " differs";
    ++n;
  }
  EXPECT_EQ(n, n_files);
}

/// What one rank met ends all of them, told once.
void expect_one_message(const ProgramResult& result, int exit_code, const std::string& part) {
  EXPECT_EQ(result.exit_code, exit_code);
  EXPECT_EQ(count_of(result.err, "boba: rank "), 1) << result.err;
  EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
}

TEST(MeasuresOnRanks, AreTheSameAlongARun) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  ASSERT_EQ(boba_on(1, folder, run_into("alone")).exit_code, 0);
  for (const int ranks : {2, 3, 4, 7}) {
    const std::string out = std::to_string(ranks);
    const ProgramResult result = boba_on(ranks, folder, run_into(out));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    expect_same_tables(folder / "alone" / "measures", folder / out / "measures", n_tables);
  }
}

TEST(MeasuresOnRanks, GoOnOnOtherRanks) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  ASSERT_EQ(boba_on(1, folder, run_into("alone", {"--set", "stage.2.strain=0.4"})).exit_code, 0);
  ProgramResult result = boba_on(3, folder, run_into("out", {"--set", "stage.2.strain=0.4", "--wall-time", "0.05"}));
  int n_stops = 0;
  for (const int ranks : {2, 4, 1, 3, 1, 1}) {
    if (result.exit_code != 75) {
      break;
    }
    ++n_stops;
    result = boba_on(ranks, folder, {"resume", "out", "--quiet", "--wall-time", n_stops < 3 ? "0.05" : "100"});
  }
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_GE(n_stops, 1);
  expect_same_tables(folder / "alone" / "measures", folder / "out" / "measures", n_tables);
}

TEST(MeasuresOnRanks, AreTheSameOnStoredFrames) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  ASSERT_EQ(boba_on(1, folder, run_into("out", {"--set", "measure=[]"})).exit_code, 0);
  const auto measure = [&](int ranks, const std::string& output) {
    return boba_on(ranks, folder,
                   {"measure", "out", "--output", output, "--sensitivity", "--q-max", "2", "--points", "20000"});
  };
  const ProgramResult alone = measure(1, "alone");
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  for (const int ranks : {2, 3, 4, 7}) {
    const std::string output = std::to_string(ranks);
    const ProgramResult result = measure(ranks, output);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(count_of(result.out, "measured into"), 1) << result.out;
    expect_same_tables(folder / "alone", folder / output, n_tables + 1); // averages.json
  }
}

/// A rigid sphere has no hull: all ranks refuse to measure it, before anything is written, and one tells why.
TEST(MeasuresOnRanks, RefuseTogetherWhatAGrainCannotHave) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene + "\n[[template]]\nname = \"dot\"\nnodes = 1\n"
                                          "[[species]]\ntemplate = \"dot\"\ncount = 1\nalpha = 0.0\n");
  for (const int ranks : {3, 4}) {
    const std::string out = std::to_string(ranks);
    const ProgramResult result =
        boba_on(ranks, folder,
                {"run", "scene.toml", "--output", out, "--quiet", "--set", "species.0.template=\"grain\"", "--set",
                 "measure=[{what = \"order\", neighbours = \"voronoi\"}]"});
    expect_one_message(result, 2, "need 4 nodes and more; template \"dot\" has 1");
    EXPECT_FALSE(std::filesystem::exists(folder / out));
  }
}

/// Rank 0 may write files of 4 kB at most.
TEST(MeasuresOnRanks, EndAllRanksWhenATableCannotBeWritten) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  ASSERT_EQ(boba_on(1, folder, run_into("out", {"--set", "measure=[]"})).exit_code, 0);
  const ProgramResult result = run_on_ranks(
      3, (folder / "").string(),
      {"/bin/sh", "-c",
       "export OMPI_MCA_btl=self,tcp; trap '' XFSZ; [ $OMPI_COMM_WORLD_RANK != 0 ] || ulimit -f 8; exec \"$@\"", "sh",
       BOBA_PROGRAM, "measure", "out", "--what", "contacts"});
  expect_one_message(result, 1, "contacts.csv");
}

} // namespace
} // namespace boba::test
