// SPDX-License-Identifier: GPL-3.0-or-later
// The engine on 1, 2, 3, 4 and 7 ranks, and work that is dealt out to them: the same numbers, to the last bit.
#include "tests/parallel/mpirun.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace boba::test {
namespace {

struct OnRanksCase {
  const char* name;
  std::vector<int> ranks;
};

class OnRanks : public ::testing::TestWithParam<OnRanksCase> {};

TEST_P(OnRanks, TheSameBits) {
  const TemporaryFolder folder;
  std::string alone;
  std::vector<int> all = {1};
  all.insert(all.end(), GetParam().ranks.begin(), GetParam().ranks.end());
  for (const int ranks : all) {
    const std::filesystem::path file = folder / std::to_string(ranks);
    const ProgramResult result =
        run_on_ranks(ranks, (folder / "").string(), {BOBA_PARALLEL_WORKER, GetParam().name, file.string()});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string bits = content_of(file);
    ASSERT_GT(bits.size(), 1000U);
    if (ranks == 1) {
      alone = bits;
    } else {
      ASSERT_TRUE(bits == alone) << GetParam().name << " differs on " << ranks << " ranks";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, OnRanks,
                         ::testing::Values(OnRanksCase{"shear", {2, 3, 4, 7}}, OnRanksCase{"mixed", {2, 7}},
                                           OnRanksCase{"stops", {}}, OnRanksCase{"velocities", {3}},
                                           OnRanksCase{"compress", {2}}, OnRanksCase{"walls", {3}},
                                           OnRanksCase{"clamps", {2}}, OnRanksCase{"migrating", {2, 3, 4, 7}},
                                           OnRanksCase{"breaking", {2, 3, 7}}, OnRanksCase{"dealt", {2, 3, 4, 7}},
                                           OnRanksCase{"scattering", {2, 3, 4, 7}}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(FailingRank, EndsAllWithOneMessage) {
  const TemporaryFolder folder;
  for (const int ranks : {2, 4}) {
    const ProgramResult result = run_on_ranks(ranks, (folder / "").string(), {BOBA_PARALLEL_WORKER, "blow_up"});
    EXPECT_EQ(result.exit_code, 1);
    const std::size_t at = result.err.find("node 5 of grain 13");
    ASSERT_NE(at, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("node 5 of grain 13", at + 1), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("rank "), std::string::npos);
  }
}

} // namespace
} // namespace boba::test
