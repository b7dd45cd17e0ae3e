// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a contact list: where grains are, which of them may meet, and which nodes, against plain loops over all
// of them.
#include "bpm/forces/contact_list.h"
#include "bpm/forces/kernels/kernels.h"
#include "tests/support/small_packings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <tuple>

namespace boba::test {
namespace {

/// Grains that touch in a small tilted cell.
Packing packing() {
  return small_packing(
      {.box = Box({0, 0, 0}, {9, 8, 10}, {1.5, -0.7, 0.4}), .n_grains = 4, .jitter = 0.05, .speed = 0.0});
}

/// The same grains where a map carries them.
Packing mapped(Packing grains, const Matrix3& map, const Vector3& shift) {
  for (Vector3& x : grains.position) {
    x = map * x + shift;
  }
  return grains;
}

struct Tracked {
  Packing grains;
  LaneLayout layout;
  LaneState state;
  ContactReach reach{ContactRanges{}, 0.3};
  GrainTracking tracking;

  explicit Tracked(Packing packing)
      : grains(std::move(packing)), layout(grains), state(grains, layout),
        tracking(layout, kernels::best_table(), reach) {
    tracking.layout_changed();
    tracking.look(state, true);
    tracking.forget_news();
  }
};

TEST(GrainTracking, FramesFollowAnAffineMapAndDeviationsAreWhatIsLeft) {
  Tracked tracked(packing());
  Matrix3 map = Eigen::AngleAxisd(0.1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  map(0, 1) += 0.01;
  const Vector3 shift(0.3, -2.0, 1.0);
  const LaneState moved(mapped(tracked.grains, map, shift), tracked.layout);
  tracked.tracking.look(moved, false);
  const std::vector<std::int64_t> first = tracked.grains.first_nodes();
  for (int g = 0; g < tracked.grains.n_grains(); ++g) {
    const TrackedGrain& grain = tracked.tracking[g];
    EXPECT_LT(grain.deviation, 3e-4); // places are floats
    EXPECT_TRUE(grain.moved.empty());
    for (int node = 0; node < tracked.layout.n_nodes(g); ++node) {
      const Vector3 x = map * tracked.grains.position[first[g] + node] + shift;
      EXPECT_LT((grain.frame(tracked.tracking.place(g, node)) - x).norm(), 2e-4);
    }
  }
}

TEST(GrainTracking, ANodeThatLeavesItsPlaceIsNoticed) {
  Tracked tracked(packing());
  Packing grains = tracked.grains;
  const std::int64_t node = grains.first_nodes()[2] + 7;
  grains.position[node].x() += 0.25;
  const LaneState moved(grains, tracked.layout);
  tracked.tracking.look(moved, false);
  const TrackedGrain& grain = tracked.tracking[2];
  EXPECT_TRUE(grain.all_noted || std::binary_search(grain.moved.begin(), grain.moved.end(), 7));
  EXPECT_FALSE(tracked.tracking[1].all_noted);
  EXPECT_TRUE(tracked.tracking[1].moved.empty());
}

TEST(GrainTracking, FastNodesAreFollowedUnlessTheyAreMany) {
  Tracked tracked(small_packing({.box = Box({0, 0, 0}, {40, 40, 40}), .n_grains = 2, .least_distance = 15.0}));
  const int n_nodes = tracked.layout.n_nodes(0);
  if (n_nodes >= 50) {
    tracked.tracking.note_fast_node(0, 3);
  }
  for (int node = 0; node < n_nodes; ++node) {
    tracked.tracking.note_fast_node(1, node);
  }
  tracked.tracking.look(tracked.state, false);
  EXPECT_EQ(tracked.tracking.follows(0, 3), n_nodes >= 50);
  EXPECT_FALSE(tracked.tracking.follows(1, 3));
}

using NodeKey = std::tuple<int, int, int, int, int, int, int>; ///< grains, image, nodes

/// All unbonded pairs of nodes nearer than `reach`, by a loop over all of them and over 125 images.
std::set<NodeKey> near_pairs(const Packing& grains, double reach) {
  std::set<NodeKey> pairs;
  const std::vector<std::int64_t> first = grains.first_nodes();
  for (int a = 0; a < grains.n_grains(); ++a) {
    std::set<std::pair<int, int>> bonded;
    for (const Bond& bond : grains.template_of(a).bonds) {
      bonded.insert({bond.i, bond.j});
    }
    for (int b = a; b < grains.n_grains(); ++b) {
      for (int image = 0; image < 125; ++image) {
        const Eigen::Vector3i n(image % 5 - 2, image / 5 % 5 - 2, image / 25 - 2);
        const bool inside = a == b && n == Eigen::Vector3i::Zero();
        const bool is_second = a == b && std::tuple(n[0], n[1], n[2]) < std::tuple(0, 0, 0);
        const Vector3 shift = grains.box.h() * n.cast<double>();
        for (std::int64_t i = first[a]; i < first[a + 1] && !is_second; ++i) {
          for (std::int64_t j = first[b]; j < first[b + 1]; ++j) {
            const int node = static_cast<int>(i - first[a]), other = static_cast<int>(j - first[b]);
            if ((inside && (other <= node || bonded.contains({node, other}))) ||
                (grains.position[i] - grains.position[j] - shift).norm() >= reach) {
              continue;
            }
            pairs.insert({a, b, n[0], n[1], n[2], node, other});
          }
        }
      }
    }
  }
  return pairs;
}

TEST(ContactList, CandidatesAreAllThatAreNear) {
  const Packing grains = packing();
  const LaneLayout layout(grains);
  const LaneState state(grains, layout);
  std::vector<NetworkData> networks;
  for (const auto& grain : grains.templates) {
    networks.emplace_back(*grain);
  }
  std::vector<const NetworkData*> network_of_grain;
  for (const Grain& grain : grains.grains) {
    network_of_grain.push_back(&networks[grain.template_index]);
  }
  ContactList list(layout, kernels::best_table(), {}, 0.3);
  EXPECT_TRUE(list.update(state, grains.box, network_of_grain));
  EXPECT_FALSE(list.update(state, grains.box, network_of_grain)); // nothing moved
  std::set<NodeKey> listed;
  for (const ContactPair& pair : list.pairs()) {
    EXPECT_TRUE(std::is_sorted(pair.candidates.begin(), pair.candidates.end()));
    for (const kernels::NodePair& nodes : pair.candidates) {
      listed.insert({pair.a, pair.b, pair.image.a, pair.image.b, pair.image.c, nodes.i, nodes.j});
    }
  }
  const std::set<NodeKey> touching = near_pairs(grains, 1.0 + 0.3), outside = near_pairs(grains, 1.0 + 1.7 * 0.3);
  EXPECT_GT(touching.size(), 20u);
  EXPECT_TRUE(std::includes(listed.begin(), listed.end(), touching.begin(), touching.end()));
  EXPECT_TRUE(std::includes(outside.begin(), outside.end(), listed.begin(), listed.end()));
  list.note_motion(Matrix3::Identity(), 1.0, 1.0); // farther than any margin
  EXPECT_TRUE(list.update(state, grains.box, network_of_grain));
}

TEST(GrainPairs, HoldTheGrainsThatAreNearAndSayHowFarTheOthersAre) {
  Tracked tracked(packing());
  GrainPairs pairs(tracked.layout, tracked.reach, Distribution::alone());
  pairs.layout_changed();
  pairs.find(tracked.tracking.grains(), tracked.grains.box, true);
  std::set<std::array<int, 5>> found;
  for (const ContactPair& pair : pairs.pairs()) {
    found.insert({pair.a, pair.b, pair.image.a, pair.image.b, pair.image.c});
  }
  EXPECT_EQ(found.size(), pairs.pairs().size());
  for (const auto& [a, b, x, y, z, i, j] : near_pairs(tracked.grains, tracked.reach.between())) {
    EXPECT_TRUE(found.contains({a, b, x, y, z}));
  }
  EXPECT_NEAR(pairs.guarantee(tracked.tracking.grains(), tracked.grains.box),
              tracked.reach.between() + tracked.reach.neighbour_margin, 1e-3);
  std::size_t sides = 0;
  for (int g = 0; g < tracked.grains.n_grains(); ++g) {
    sides += pairs.sides(g).size();
  }
  EXPECT_EQ(sides, 2 * pairs.pairs().size());
}

TEST(ContactReach, InsideIsComparedWithBetween) {
  const ContactReach reach({.between = 1.4, .inside = 1.0}, 0.3);
  EXPECT_DOUBLE_EQ(reach.inside(), 1.3);
  EXPECT_DOUBLE_EQ(reach.between(), 1.4 + 1.6 * 0.3);
  EXPECT_DOUBLE_EQ(reach.later_inside(), 0.4);
  EXPECT_LT(reach.reserve(), 0.3);
}

} // namespace
} // namespace boba::test
