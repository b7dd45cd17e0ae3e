// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/near_pairs.h"
#include "bpm/grain/random.h"
#include "bpm/grain/soft_relaxation.h"
#include "bpm/grain/spatial_order.h"

#include <gtest/gtest.h>
#include <set>

namespace boba {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> random_points(int n, const Vector3d& lengths, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vector3d> points(n);
  for (Vector3d& x : points) {
    x = lengths.cwiseProduct(random.vector(0.5));
  }
  return points;
}

/// Every pair and every one of 27 images, no grid.
std::set<std::pair<int, int>> brute_force(const std::vector<Vector3d>& x, double cutoff, const Vector3d& period,
                                          int images) {
  std::set<std::pair<int, int>> found;
  for (int i = 0; i < static_cast<int>(x.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(x.size()); ++j) {
      for (int a = -images; a <= images; ++a) {
        for (int b = -images; b <= images; ++b) {
          for (int c = -images; c <= images; ++c) {
            if ((x[i] - x[j] + period.cwiseProduct(Vector3d(a, b, c))).norm() < cutoff) {
              found.insert({i, j});
            }
          }
        }
      }
    }
  }
  return found;
}

void expect_same(const std::vector<NearPair>& pairs, const std::set<std::pair<int, int>>& expected) {
  std::set<std::pair<int, int>> found;
  for (const NearPair& pair : pairs) {
    EXPECT_TRUE(found.insert({pair.i, pair.j}).second) << "pair listed twice";
  }
  EXPECT_EQ(found, expected);
}

TEST(NearPairs, FreePointsMatchBruteForce) {
  const auto x = random_points(300, {6, 9, 4}, 3);
  expect_same(near_pairs(x, 1.5, std::nullopt), brute_force(x, 1.5, Vector3d::Zero(), 0));
}

TEST(NearPairs, PeriodicPointsMatchBruteForceDownToTwoCells) {
  const Vector3d period(3.1, 4.7, 9.3); // two, three and six cells of 1.5
  const auto x = random_points(200, period, 4);
  const auto pairs = near_pairs(x, 1.5, period);
  expect_same(pairs, brute_force(x, 1.5, period, 1));
  const auto shifts = image_shifts(period);
  for (const NearPair& pair : pairs) {
    EXPECT_LT((x[pair.i] - x[pair.j] - shifts[pair.shift]).norm(), 1.5);
  }
}

TEST(NearPairs, RefusesABoxWhereAPairMeetsTwice) {
  EXPECT_THROW(near_pairs(random_points(10, {2.9, 8, 8}, 1), 1.5, Vector3d(2.9, 8, 8)), std::invalid_argument);
}

TEST(HilbertOrder, FillsAGridInUnitSteps) {
  std::vector<Vector3d> grid;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      for (int k = 0; k < 8; ++k) {
        grid.emplace_back(i, j, k);
      }
    }
  }
  const auto order = hilbert_order(grid);
  ASSERT_EQ(std::set<int>(order.begin(), order.end()).size(), grid.size());
  for (std::size_t n = 1; n < order.size(); ++n) {
    EXPECT_DOUBLE_EQ((grid[order[n]] - grid[order[n - 1]]).norm(), 1.0);
  }
}

TEST(SoftRelaxation, TwoOverlappingNodesPartAndKeepTheirMomentum) {
  std::vector<Vector3d> x{{-0.3, 0, 0}, {0.3, 0, 0}}, v{{0, 0.01, 0}, {0, 0.01, 0}};
  const auto result = relax_soft_nodes(x, v, {}, {.time_step = 0.05, .max_steps = 400, .rest_force = 1e-9});
  EXPECT_GE((x[1] - x[0]).norm(), 1.0);
  EXPECT_LT(result.largest_force, 1e-12);
  EXPECT_NEAR((v[0] + v[1]).x(), 0.0, 1e-14);
  EXPECT_NEAR((v[0] + v[1]).y(), 0.02, 1e-14);
}

TEST(SoftRelaxation, NodesInAPeriodicCellPushAcrossItsFaces) {
  const Vector3d period(4, 4, 4);
  std::vector<Vector3d> x{{-1.8, 0, 0}, {1.8, 0, 0}}, v(2, Vector3d::Zero());
  relax_soft_nodes(x, v, {.period = period, .wall_force = {}},
                   {.time_step = 0.05, .max_steps = 100, .rest_force = 1e-9});
  EXPECT_GT(wrapped(x[0] - x[1], period).norm(), 0.99);
}

} // namespace
} // namespace boba
