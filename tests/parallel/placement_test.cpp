// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/parallel/placement.h"
#include "tests/support/small_packings.h"

#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>

namespace boba::test {
namespace {

PlacementInput cubic(const Packing& packing, int side, int n_ranks, int lanes) {
  PlacementInput input = {&packing, n_ranks, lanes, {}, {}};
  for (int g = 0; g < packing.n_grains(); ++g) {
    const Eigen::Vector3i cell(g % side, g / side % side, g / side / side);
    input.fractional.emplace_back((cell.cast<double>() + Vector3::Constant(0.5)) / side);
    input.cost.push_back(1.0);
  }
  return input;
}

Packing grains(int n) {
  Packing packing;
  packing.templates = {small_ball(1.5, 1)};
  packing.grains.assign(n, Grain{.alpha = 2.0});
  return packing;
}

TEST(Placement, CutsBetweenBlocksAndBalances) {
  const Packing packing = grains(512);
  for (const int n_ranks : {1, 2, 3, 4, 7, 16, 64}) {
    const PlacementInput input = cubic(packing, 8, n_ranks, 8);
    const std::vector<int> owner = place_grains(input);
    std::vector<int> count(n_ranks, 0);
    for (const int rank : owner) {
      ++count[rank];
    }
    for (const int n : count) {
      EXPECT_EQ(n % 8, 0);
      EXPECT_LE(std::abs(n - 512 / n_ranks), 8);
    }
    EXPECT_LE(imbalance(input, owner), 1.0 + 8.0 * n_ranks / 512);
  }
}

TEST(Placement, GivesEveryRankSomethingWhenBlocksAreFew) {
  const Packing packing = grains(27);
  const PlacementInput input = cubic(packing, 3, 7, 8);
  const std::vector<int> owner = place_grains(input);
  for (int rank = 0; rank < 7; ++rank) {
    EXPECT_GE(std::count(owner.begin(), owner.end(), rank), 3);
  }
}

TEST(Placement, FollowsCost) {
  const Packing packing = grains(64);
  PlacementInput input = cubic(packing, 4, 2, 1);
  const std::vector<int> row = along_curve(std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}, input.fractional);
  EXPECT_EQ(row.size(), 8U);
  const std::vector<int> even = place_grains(input);
  EXPECT_EQ(std::count(even.begin(), even.end(), 0), 32);
  for (int g = 0; g < 64; ++g) {
    input.cost[g] = even[g] == 0 ? 3.0 : 1.0; // what rank 0 has is three times as expensive
  }
  EXPECT_NEAR(imbalance(input, even), 1.5, 1e-12);
  const std::vector<int> better = place_grains(input);
  EXPECT_NEAR(imbalance(input, better), 1.0, 0.05);
}

// A compact piece of 8^3 has fewer neighbours elsewhere than a slice of the list of grains.
TEST(Placement, PiecesAreCompact) {
  const Packing packing = grains(512);
  const PlacementInput input = cubic(packing, 8, 8, 8);
  const std::vector<int> owner = place_grains(input);
  const auto cut_faces = [&](const auto& rank_of) {
    int n = 0;
    for (int g = 0; g < 512; ++g) {
      n += g % 8 < 7 && rank_of(g) != rank_of(g + 1);
      n += g / 8 % 8 < 7 && rank_of(g) != rank_of(g + 8);
      n += g / 64 < 7 && rank_of(g) != rank_of(g + 64);
    }
    return n;
  };
  EXPECT_EQ(cut_faces([&](int g) { return owner[g]; }), 3 * 64); // eight cubes of 4^3
  EXPECT_EQ(cut_faces([](int g) { return g / 64; }), 7 * 64);    // slices
}

} // namespace
} // namespace boba::test
