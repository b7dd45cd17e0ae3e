// SPDX-License-Identifier: GPL-3.0-or-later
// The engine on 1, 2, 3, 4 and 7 ranks: the same numbers, to the last bit.
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace boba::test {
namespace {

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs the worker on so many ranks, without mpirun for one.
ProgramResult run_on(int ranks, const std::string& folder, const std::vector<std::string>& arguments) {
  // Ranks of a test share cores; a container's user may be root.
  for (const char* name : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "OMPI_MCA_mpi_yield_when_idle"}) {
    setenv(name, "1", 1);
  }
  std::vector<std::string> command;
  if (ranks > 1) {
    command = {BOBA_MPIRUN, "--oversubscribe", "--bind-to", "none", "-np", std::to_string(ranks)};
  }
  command.push_back(BOBA_PARALLEL_WORKER);
  command.insert(command.end(), arguments.begin(), arguments.end());
  return run_program(command, folder);
}

class OnRanks : public ::testing::TestWithParam<const char*> {};

TEST_P(OnRanks, TheSameBits) {
  const TemporaryFolder folder;
  std::string alone;
  for (const int ranks : {1, 2, 3, 4, 7}) {
    const std::string file = folder.path() / ("bits" + std::to_string(ranks));
    const ProgramResult result = run_on(ranks, folder.path(), {GetParam(), file});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string bits = content(file);
    ASSERT_GT(bits.size(), 1000U);
    if (ranks == 1) {
      alone = bits;
    } else {
      ASSERT_TRUE(bits == alone) << GetParam() << " differs on " << ranks << " ranks";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, OnRanks,
                         ::testing::Values("shear", "mixed", "velocities", "compress", "walls", "clamps", "migrating"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST(FailingRank, EndsAllWithOneMessage) {
  const TemporaryFolder folder;
  for (const int ranks : {2, 4}) {
    const ProgramResult result = run_on(ranks, folder.path(), {"blow_up"});
    EXPECT_NE(result.exit_code, 0);
    const std::size_t at = result.err.find("node 5 of grain 13");
    ASSERT_NE(at, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("node 5 of grain 13", at + 1), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("rank "), std::string::npos);
  }
}

} // namespace
} // namespace boba::test
