// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/lane_layout.h"
#include "tests/support/small_packings.h"

#include <gtest/gtest.h>
#include <set>

namespace boba::test {
namespace {

/// So many grains of one template each, none of which the layout looks at beyond their number of nodes.
Packing grains(const std::vector<Grain>& all) {
  Packing packing;
  packing.templates = {small_ball(1.5, 1), small_ball(2.0, 2)};
  packing.grains = all;
  return packing;
}

std::vector<Grain> alike(int n, int template_index, double alpha) {
  return std::vector<Grain>(n, Grain{.template_index = template_index, .alpha = alpha});
}

TEST(LaneLayout, GivesEveryNumberOfEveryGrainAPlaceOfItsOwn) {
  std::vector<Grain> all = alike(11, 0, 2.0);
  for (const Grain& grain : alike(3, 1, 0.0)) {
    all.push_back(grain);
  }
  for (const Precision precision : {Precision::full, Precision::mixed}) {
    const Packing packing = grains(all);
    const LaneLayout layout(packing, precision);
    std::set<std::int64_t> places;
    std::size_t numbers = 0;
    for (int g = 0; g < packing.n_grains(); ++g) {
      ASSERT_TRUE(layout.holds(g));
      EXPECT_EQ(layout.n_nodes(g), packing.template_of(g).n_nodes());
      const Block& block = layout.blocks()[layout.block_of(g)];
      EXPECT_EQ(block.grain[layout.lane_of(g)], g);
      EXPECT_EQ(block.template_index, packing.grains[g].template_index);
      for (int node = 0; node < layout.n_nodes(g); ++node) {
        for (int component = 0; component < 3; ++component, ++numbers) {
          const std::int64_t at = layout.index(g, node, component);
          places.insert(at);
          EXPECT_GE(at, 0);
          EXPECT_LT(at, layout.size());
        }
      }
    }
    EXPECT_EQ(places.size(), numbers);
  }
}

TEST(LaneLayout, BlocksBeginOnCacheLines) {
  const LaneLayout layout(grains(alike(20, 0, 2.0)));
  for (const Block& block : layout.blocks()) {
    EXPECT_EQ(block.offset % 8, 0);
  }
}

TEST(LaneLayout, KeepsGrainsWithoutVolumesApart) {
  std::vector<Grain> all = alike(4, 0, 2.0);
  all[1].alpha = 0.0;
  all[3].alpha = 0.0;
  const LaneLayout layout(grains(all));
  ASSERT_EQ(layout.blocks().size(), 2U);
  for (const Block& block : layout.blocks()) {
    EXPECT_EQ(block.n_grains(), 2);
    for (const int g : block.grain) {
      EXPECT_TRUE(g < 0 || (all[g].alpha != 0.0) == block.many_body);
    }
  }
}

TEST(LaneLayout, LanesFollowFromAllGrainsThatCouldShareABlock) {
  const auto lanes = [](int n, Precision precision) {
    return LaneLayout(grains(alike(n, 0, 2.0)), precision).blocks().front().n_lanes;
  };
  EXPECT_EQ(lanes(1, Precision::full), 1);
  EXPECT_EQ(lanes(2, Precision::full), 8);
  EXPECT_EQ(lanes(9, Precision::full), 8);
  EXPECT_EQ(lanes(8, Precision::mixed), 8);
  EXPECT_EQ(lanes(9, Precision::mixed), 16);
  // A rank that holds one of nine grains has the block that all nine would have.
  const Packing nine = grains(alike(9, 0, 2.0));
  const std::vector<int> own = {5};
  const LaneLayout part(nine, Precision::mixed, own);
  EXPECT_EQ(part.blocks().front().n_lanes, 16);
  EXPECT_EQ(part.grains(), own);
  EXPECT_FALSE(part.holds(4));
}

TEST(LaneLayout, FilledIsTheShareOfLanesWithAGrain) {
  EXPECT_DOUBLE_EQ(LaneLayout(grains(alike(8, 0, 2.0))).filled(), 1.0);
  EXPECT_DOUBLE_EQ(LaneLayout(grains(alike(12, 0, 2.0))).filled(), 0.75);
}

} // namespace
} // namespace boba::test
