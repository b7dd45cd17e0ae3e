// SPDX-License-Identifier: GPL-3.0-or-later
// A write that fails on one of several ranks: one message that names the file, exit code 1, nobody waits for ever, and
// what is left can be gone on from on other ranks, to the same end.
#include "tests/parallel/program_on_ranks.h"
#include "tests/robustness/app/same_run.h"

#include <gtest/gtest.h>

namespace boba::test {
namespace {

const std::vector<std::string> settings = {"--quiet",
                                           "--set",
                                           "species.0.count=12",
                                           "--set",
                                           "stage.2.strain=0.02",
                                           "--set",
                                           "output.checkpoint.every_time=150",
                                           "--set",
                                           "output.trajectory.every_strain=0.005"};

class WriteErrorsOnRanks : public ::testing::Test {
protected:
  void SetUp() override {
    folder_.file("scene.toml", small_scene);
    ASSERT_EQ(on(1, "alone", "").exit_code, 0);
  }

  /// A new run on so many ranks; each goes through `before` in its shell first.
  ProgramResult on(int ranks, const std::string& output, const std::string& before) {
    std::vector<std::string> command = {
        "/bin/sh", "-c", before + "exec \"$@\"", "sh", BOBA_PROGRAM, "run", "scene.toml", "--output", output};
    command.insert(command.end(), settings.begin(), settings.end());
    if (ranks > 1) { // a rank that waited for ever would be found out
      command.insert(command.begin(), {"/usr/bin/timeout", "120"});
    }
    return run_on_ranks(ranks, (folder_ / "").string(), command);
  }

  void expect_message_and_same_end(const ProgramResult& result, const std::string& file, int ranks_after) {
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_EQ(count_of(result.err, "boba: rank"), 1) << result.err;
    EXPECT_NE(result.err.find(file), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("signal"), std::string::npos) << result.err;
    const ProgramResult resumed =
        run_on_ranks(ranks_after, (folder_ / "").string(), {BOBA_PROGRAM, "resume", "faulty", "--quiet"});
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    expect_same_run(folder_ / "alone", folder_ / "faulty");
    std::filesystem::remove_all(folder_ / "faulty");
  }

  /// Shell words that let a rank's call number `at` to files named so fail, and perhaps all later ones.
  static std::string fault(int rank, const std::string& name, int at, bool later_too) {
    return "[ $OMPI_COMM_WORLD_RANK != " + std::to_string(rank) + " ] || export LD_PRELOAD=" + BOBA_FAIL_WRITE +
           " BOBA_FAIL_NAME=" + name + " BOBA_FAIL_AT=" + std::to_string(at) +
           " BOBA_FAIL_ON=" + (later_too ? "1" : "0") + "; ";
  }

  const TemporaryFolder folder_;
};

TEST_F(WriteErrorsOnRanks, InTheTrajectoryAreToldOnceAndLoseNothing) {
  struct Case {
    int rank, at;
    bool later_too;
  };
  // Ranks other than 0 write nodes alone: image, velocity and position of each frame. Rank 0's calls are HDF5's too.
  int ranks_after = 0;
  for (const Case& c : {Case{1, 1, false}, Case{2, 9, false}, Case{2, 12, true}, Case{0, 30, false}, Case{0, 45, true},
                        Case{0, 75, false}}) {
    SCOPED_TRACE("rank " + std::to_string(c.rank) + ", call " + std::to_string(c.at));
    const ProgramResult result = on(3, "faulty", fault(c.rank, "trajectory.h5", c.at, c.later_too));
    expect_message_and_same_end(result, "trajectory.h5", 1 + ranks_after++ % 3);
  }
}

// Each rank writes its nodes of three entries, then syncs; rank 0 also makes the file, and gives it its name in the
// end.
TEST_F(WriteErrorsOnRanks, InACheckpointLeaveTheOneBefore) {
  struct Case {
    int rank, at;
    bool later_too;
  };
  int ranks_after = 0;
  for (const Case& c : {Case{1, 15, false}, Case{2, 22, true}, Case{0, 25, false}, Case{0, 45, true}}) {
    SCOPED_TRACE("rank " + std::to_string(c.rank) + ", call " + std::to_string(c.at));
    const ProgramResult result = on(3, "faulty", fault(c.rank, "checkpoint-", c.at, c.later_too));
    EXPECT_NE(result.err.find("checkpoint not written"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("the last one remains"), std::string::npos) << result.err;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "faulty/checkpoints")) {
      EXPECT_NE(entry.path().extension(), ".part");
    }
    expect_message_and_same_end(result, "checkpoint-", 1 + ranks_after++ % 3);
  }
}

TEST_F(WriteErrorsOnRanks, AFileThatMayNotGrowIsAMessage) {
  // In blocks of 512 bytes; the trajectory is the largest file. MPI's own files of shared memory would be larger still.
  const ProgramResult result = on(2, "faulty", "export OMPI_MCA_btl=self,tcp; trap '' XFSZ; ulimit -f 5800; ");
  expect_message_and_same_end(result, "trajectory.h5", 1);
}

} // namespace
} // namespace boba::test
