// SPDX-License-Identifier: GPL-3.0-or-later
// The program under mpirun: the same scene, the same files, to the last bit; stopped on some ranks and continued on
// others.
#include "bpm/app/output_record.h"
#include "bpm/io/checkpoint.h"
#include "tests/parallel/program_on_ranks.h"
#include "tests/robustness/app/same_run.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

std::vector<std::string> run_into(const std::string& output, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{
      "run",   "scene.toml",         "--output", output,
      "--set", "species.0.count=12", "--set",    "stage.2.rate=2e-3",
      "--set", "stage.2.strain=0.1", "--set",    "measure=[{what = \"motion, order\", every_strain = 0.05}]"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(ProgramOnRanks, WritesTheSameFiles) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  ASSERT_EQ(boba_on(1, folder, run_into("alone")).exit_code, 0);
  for (const int ranks : {2, 3}) {
    const std::string out = std::to_string(ranks);
    const ProgramResult result = boba_on(ranks, folder, run_into(out));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(count_of(result.out, "done at step"), 1) << result.out;
    EXPECT_NE(result.out.find(out + " ranks of "), std::string::npos) << result.out;
    expect_same_run(folder / "alone", folder / out);
    // All but the sums of the files: the column of speed in table.csv is never the same.
    const auto checkpoint = [&](const std::string& run) {
      SavedState data = latest_checkpoint(folder / run / "checkpoints").data;
      EXPECT_EQ(data.erase(output_record_name), 1U);
      std::filesystem::create_directories(folder / ("compared-" + run));
      return content_of(write_checkpoint(folder / ("compared-" + run), data));
    };
    EXPECT_TRUE(checkpoint("alone") == checkpoint(out)) << "the last checkpoints differ";
    for (const auto& entry : std::filesystem::directory_iterator(folder / "alone" / "measures")) {
      EXPECT_TRUE(content_of(entry.path()) == content_of(folder / out / "measures" / entry.path().filename()))
          << entry.path();
    }
  }
}

TEST(ProgramOnRanks, GoesOnOnOtherRanks) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  for (const char* precision : {"double", "mixed"}) {
    const std::string set = std::string("run.precision=\"") + precision + "\"", out = std::string("out-") + precision;
    const std::string alone = std::string("alone-") + precision;
    ASSERT_EQ(boba_on(1, folder, run_into(alone, {"--set", set})).exit_code, 0);
    ProgramResult result = boba_on(4, folder, run_into(out, {"--set", set, "--wall-time", "0.05"}));
    int n_stops = 0;
    for (const int ranks : {1, 3, 2, 4, 1, 3, 1, 1, 1, 1}) {
      if (result.exit_code != 75) {
        break;
      }
      ++n_stops;
      result = boba_on(ranks, folder, {"resume", out, "--wall-time", n_stops < 3 ? "0.05" : "100"});
    }
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_GE(n_stops, 2);
    expect_same_run(folder / alone, folder / out);
  }
}

TEST(ProgramOnRanks, TellsWrongInputOnce) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  const ProgramResult wrong = boba_on(3, folder, run_into("out", {"--set", "stage.1.rate=-1"}));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_EQ(count_of(wrong.err, "boba: "), 1) << wrong.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  const ProgramResult unknown = boba_on(3, folder, {"run", "scene.toml", "--no-such-option"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_EQ(count_of(unknown.err, "--no-such-option"), 1) << unknown.err;
}

/// One rank is killed: the others end too, and the run can be gone on with, on fewer ranks or alone.
TEST(ProgramOnRanks, SurvivesAKilledRank) {
  const TemporaryFolder folder;
  folder.file("scene.toml", small_scene);
  const std::vector<std::string> often{"--set", "output.checkpoint.every_time=5", "--set", "stage.2.strain=0.4"};
  ASSERT_EQ(boba_on(1, folder, run_into("alone", often)).exit_code, 0);
  std::vector<std::string> arguments = run_into("out", often);
  arguments.insert(arguments.begin(), BOBA_PROGRAM);
  // Rank 1 is killed once some checkpoints are there.
  std::vector<std::string> command{
      "/bin/sh", "-c",
      "[ $OMPI_COMM_WORLD_RANK != 1 ] || { me=$$; (while kill -0 $me; do for n in 4 5 6 7 8; do "
      "[ ! -e out/checkpoints/checkpoint-00000$n.boba ] || kill -9 $me; done; sleep 0.01; done) >/dev/null 2>&1 & }; "
      "exec \"$@\"",
      "sh"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const ProgramResult killed = run_on_ranks(4, (folder / "").string(), command);
  ASSERT_NE(killed.exit_code, 0);
  EXPECT_EQ(killed.out.find("done at step"), std::string::npos);
  for (const int ranks : {1, 3}) {
    const std::string copy = "out-" + std::to_string(ranks);
    std::filesystem::copy(folder / "out", folder / copy, std::filesystem::copy_options::recursive);
    const ProgramResult result = boba_on(ranks, folder, {"resume", copy});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    expect_same_run(folder / "alone", folder / copy);
  }
}

} // namespace
} // namespace boba::test
