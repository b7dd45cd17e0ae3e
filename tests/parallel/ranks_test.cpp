// SPDX-License-Identifier: GPL-3.0-or-later
// What ranks do together, on the ranks that mpirun starts; every rank runs every test.
#include "bpm/parallel/message_passing.h"
#include "bpm/parallel/star_forest.h"

#include <gtest/gtest.h>

namespace boba::test {
namespace {

Ranks ranks() {
  return Ranks::of_world();
}

TEST(Ranks, AreCountedFromZero) {
  EXPECT_EQ(ranks().size(), BOBA_TEST_RANKS);
  EXPECT_EQ(ranks().sum(ranks().rank()), BOBA_TEST_RANKS * (BOBA_TEST_RANKS - 1) / 2);
  EXPECT_EQ(ranks().is_root(), ranks().rank() == 0);
}

TEST(Ranks, AgreeOnExtremesAndFlags) {
  const int rank = ranks().rank(), last = BOBA_TEST_RANKS - 1;
  EXPECT_EQ(ranks().largest(-1.0 - rank), -1.0);
  EXPECT_EQ(ranks().smallest(-1.0 - rank), -1.0 - last);
  EXPECT_TRUE(ranks().any(rank == last));
  EXPECT_FALSE(ranks().any(false));
  std::vector<char> flags = {rank == last, false, rank == 0};
  ranks().any(flags);
  EXPECT_EQ(flags, (std::vector<char>{1, 0, 1}));
}

TEST(Ranks, BroadcastWhatTheFirstHolds) {
  std::string text = ranks().is_root() ? "from the first" : "other";
  std::vector<double> numbers(ranks().is_root() ? 3 : 0, 2.5);
  int whole = ranks().rank() + 7;
  ranks().broadcast(text);
  ranks().broadcast(numbers);
  ranks().broadcast(whole);
  EXPECT_EQ(text, "from the first");
  EXPECT_EQ(numbers, std::vector<double>(3, 2.5));
  EXPECT_EQ(whole, 7);
}

TEST(Ranks, GatherInTheirOrder) {
  const std::vector<int> own(ranks().rank() + 1, ranks().rank()); // rank r has r + 1 items
  std::vector<int> expected;
  std::vector<std::int64_t> counts;
  for (int r = 0; r < BOBA_TEST_RANKS; ++r) {
    expected.insert(expected.end(), r + 1, r);
    counts.push_back(r + 1);
  }
  EXPECT_EQ(ranks().gathered(own), ranks().is_root() ? expected : std::vector<int>{});
  std::vector<int> all(expected.size());
  ranks().gather_all(own.data(), all.data(), counts, sizeof(int));
  EXPECT_EQ(all, expected);
}

TEST(Ranks, ShareTheRowsOfGrainsThatTheyOwn) {
  std::vector<int> owner;
  for (int g = 0; g < 2 * BOBA_TEST_RANKS + 1; ++g) {
    owner.push_back((g * 2) % BOBA_TEST_RANKS);
  }
  const Ownership ownership(owner, BOBA_TEST_RANKS, std::vector<int>(owner.size(), 1));
  std::vector<double> table(2 * owner.size(), -1.0);
  for (const int g : ownership.grains_of(ranks().rank())) {
    table[2 * g] = g;
    table[2 * g + 1] = 10.0 * g;
  }
  ranks().share_rows(table, 2, ownership);
  for (std::size_t g = 0; g < owner.size(); ++g) {
    EXPECT_EQ(table[2 * g], static_cast<double>(g));
    EXPECT_EQ(table[2 * g + 1], 10.0 * static_cast<double>(g));
  }
}

TEST(Ranks, AllThrowWhatOneHasMet) {
  const int last = BOBA_TEST_RANKS - 1;
  try {
    ranks().collectively([&] {
      if (ranks().rank() == last) {
        throw std::invalid_argument("the last does not like this");
      }
    });
    FAIL() << "nothing was thrown";
  } catch (const RankError& error) {
    EXPECT_EQ(error.rank, last);
    EXPECT_TRUE(error.is_wrong_input);
    EXPECT_STREQ(error.what(), "the last does not like this");
  }
  int calls = 0;
  ranks().on_root([&] { ++calls; });
  EXPECT_EQ(calls, ranks().is_root() ? 1 : 0);
}

// Each rank owns two roots and holds copies of all roots of the next rank, in reverse.
TEST(StarForest, CopiesRootsToLeavesAndBack) {
  const int rank = ranks().rank(), next = (rank + 1) % BOBA_TEST_RANKS;
  const std::vector<RootPlace> leaves = {{next, 1}, {next, 0}};
  const auto forest = make_star_forest(2, leaves);
  const std::vector<double> roots = {10.0 * rank, 10.0 * rank + 1.0};
  std::vector<double> copies(2, -1.0);
  forest->copy(sizeof(double), roots.data(), copies.data());
  EXPECT_EQ(copies, (std::vector<double>{10.0 * next + 1.0, 10.0 * next}));
  EXPECT_EQ(forest->wanted(), (std::vector<int>{0, 1}));
  EXPECT_EQ(forest->incoming().items, 2);
  EXPECT_EQ(forest->incoming().messages, 1);
  std::vector<double> back(2, -1.0);
  for (double& value : copies) {
    value += 0.5;
  }
  forest->collect(sizeof(double), copies.data(), back.data());
  EXPECT_EQ(back, (std::vector<double>{10.0 * rank + 0.5, 10.0 * rank + 1.5}));
}

TEST(StarForest, LeavesGoWhereTheyAreToldAndOtherPlacesStay) {
  const int rank = ranks().rank(), next = (rank + 1) % BOBA_TEST_RANKS;
  const std::vector<RootPlace> leaves = {{next, 0}};
  const std::vector<int> places = {2};
  const auto forest = make_star_forest(3, leaves, places);
  const std::vector<std::int32_t> roots = {rank, -5, -5};
  std::vector<std::int32_t> copies(4, 99);
  forest->copy(sizeof(std::int32_t), roots.data(), copies.data());
  EXPECT_EQ(copies, (std::vector<std::int32_t>{99, 99, next, 99}));
  EXPECT_EQ(forest->wanted(), std::vector<int>{0});
}

} // namespace
} // namespace boba::test

int main(int argc, char** argv) {
  const boba::MessagePassing session;
  testing::InitGoogleTest(&argc, argv);
  return session.ranks().any(RUN_ALL_TESTS() != 0) ? 1 : 0;
}
