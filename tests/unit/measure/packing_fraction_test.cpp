// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/packing_fraction.h"
#include "bpm/measure/philox.h"
#include "bpm/measure/point_grid.h"
#include "tests/support/shapes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <omp.h>
#include <stdexcept>

namespace {

using namespace boba;
using namespace boba::measure;
using std::numbers::pi;

// Source of the bits: the known-answer file of Random123 (philox4x32, 10 rounds), counter and key 0:
// 6627e8d5 e169c58d bc57ac4c 9b00dbd8; the fourth word's low 30 bits are ten more for each coordinate.
TEST(RandomPoint, IsPhiloxOfIndexAndSeed) {
  const auto u = random_point(0, 0);
  EXPECT_EQ(u[0], 0x6627e8d5p-32 + 0x3d8p-42);
  EXPECT_EQ(u[1], 0xe169c58dp-32 + 0x036p-42);
  EXPECT_EQ(u[2], 0xbc57ac4cp-32 + 0x1b0p-42);
  EXPECT_NE(random_point(1, 0), random_point(0, 1));
}

TEST(PointGrid, FindsEveryImageOnce) {
  const Box box({1.0, -2.0, 0.5}, {5.0, 4.0, 3.0}, {2.0, -1.2, 0.9});
  std::vector<Vector3> points;
  for (int i = 0; i < 300; ++i) {
    const auto u = random_point(3, i);
    points.push_back(box.to_position({u[0], u[1], u[2]}));
  }
  const PointGrid grid(box, points, 0.7);
  for (const double radius : {0.6, 1.3, 4.0}) { // 4.0 reaches images of images
    const Vector3 x(9.0, -11.0, 2.0);
    std::vector<int> found(points.size(), 0), expected(points.size(), 0);
    grid.visit_near(x, radius, [&](std::int64_t p, const Vector3& image) { found[p] += (image - x).norm() < radius; });
    for (std::size_t p = 0; p < points.size(); ++p) {
      for (int k = 0; k < 21 * 21 * 21; ++k) {
        const Vector3 shift = box.h() * Eigen::Vector3i(k % 21 - 10, k / 21 % 21 - 10, k / 441 - 10).cast<double>();
        expected[p] += (points[p] + shift - x).norm() < radius;
      }
    }
    EXPECT_EQ(found, expected) << radius;
    EXPECT_GT(std::accumulate(found.begin(), found.end(), 0), 0);
  }
}

/// Equal cubes of edge 2 whose corners carry nodes, in a tilted cell, some of them across its faces or far outside.
struct CubePacking {
  Box box{{-3.0, 1.0, 2.0}, {8.0, 7.0, 6.0}, {3.0, -2.0, 1.5}};
  std::vector<Vector3> positions;
  std::vector<std::int64_t> first_node{0};
  std::vector<ConvexHull> hulls;

  CubePacking() {
    add(Matrix3::Identity(), {0.5, 0.5, 0.5}, {0, 0, 0});
    add(shapes::some_rotation(), {0.0, 0.0, 0.0}, {3, -2, 1});
  }
  void add(const Matrix3& rotation, const Vector3& fractional, const Vector3& image) {
    const auto nodes = shapes::moved(shapes::cube(), rotation, box.to_position(fractional + image));
    positions.insert(positions.end(), nodes.begin(), nodes.end());
    first_node.push_back(static_cast<std::int64_t>(positions.size()));
    hulls.push_back(convex_hull(nodes));
  }
  GrainNodes grains() const { return {positions, first_node}; }
  double hull_share() const { return 2.0 * 8.0 / box.volume(); }
  double node_share() const { return 16.0 * pi / 6.0 / box.volume(); }
  /// An eighth of each node's sphere is inside its cube.
  double both_share() const { return hull_share() + 7.0 / 8.0 * node_share(); }
};

TEST(PackingFraction, CubesWithNodesAtTheirCorners) {
  const CubePacking packing;
  const PackingFraction phi = packing_fraction(packing.box, packing.grains(), packing.hulls, {.n_points = 400000});
  EXPECT_EQ(phi.n_points, 400000);
  EXPECT_NEAR(phi.hulls.value, packing.hull_share(), 4.0 * phi.hulls.standard_error);
  EXPECT_NEAR(phi.nodes.value, packing.node_share(), 4.0 * phi.nodes.standard_error);
  EXPECT_NEAR(phi.both.value, packing.both_share(), 4.0 * phi.both.standard_error);
  EXPECT_LT(phi.both.standard_error, 8e-4);
}

TEST(PackingFraction, StatedErrorCoversTheTruthInNinetyFivePercentOfSeeds) {
  const CubePacking packing;
  int covered_both = 0, covered_nodes = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const PackingFraction phi =
        packing_fraction(packing.box, packing.grains(), packing.hulls, {.seed = seed, .n_points = 3000});
    covered_both += std::abs(phi.both.value - packing.both_share()) < 1.96 * phi.both.standard_error;
    covered_nodes += std::abs(phi.nodes.value - packing.node_share()) < 1.96 * phi.nodes.standard_error;
  }
  // 190 expected; the count itself scatters by sqrt(200 * 0.95 * 0.05) = 3.1. Both limits are three of these away.
  EXPECT_GE(covered_both, 181);
  EXPECT_LE(covered_both, 199);
  EXPECT_GE(covered_nodes, 181);
  EXPECT_LE(covered_nodes, 199);
}

TEST(PackingFraction, TouchingSpheresOnFccFillTheirKnownShare) {
  // One node a grain, no hull. Touching spheres of diameter 1: cube edge sqrt(2), phi = pi / (3 sqrt(2)) = 0.74048.
  const double a = std::sqrt(2.0);
  const Box box(Vector3::Zero(), Vector3::Constant(a));
  const std::vector<Vector3> nodes = {{0, 0, 0}, {0, a / 2, a / 2}, {a / 2, 0, a / 2}, {a / 2, a / 2, 0}};
  const std::vector<std::int64_t> first_node = {0, 1, 2, 3, 4};
  const PackingFraction phi = packing_fraction(box, {nodes, first_node}, {}, {.n_points = 1000000});
  EXPECT_NEAR(phi.both.value, 0.74048, 4.0 * phi.both.standard_error);
  EXPECT_EQ(phi.hulls.value, 0.0);
  EXPECT_EQ(phi.both.value, phi.nodes.value);
}

TEST(PackingFraction, SameForAnyNumberOfThreadsAndOtherForAnotherSeed) {
  const CubePacking packing;
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = packing_fraction(packing.box, packing.grains(), packing.hulls, {.seed = 7});
  omp_set_num_threads(5);
  const auto five = packing_fraction(packing.box, packing.grains(), packing.hulls, {.seed = 7});
  const auto other = packing_fraction(packing.box, packing.grains(), packing.hulls, {.seed = 8});
  omp_set_num_threads(before);
  EXPECT_EQ(one.both.value, five.both.value);
  EXPECT_EQ(one.nodes.value, five.nodes.value);
  EXPECT_NE(one.both.value, other.both.value);
}

TEST(PackingFraction, DrawsPointsUntilTheTargetErrorIsReached) {
  const CubePacking packing;
  const PackingFraction phi = packing_fraction(packing.box, packing.grains(), packing.hulls, {.target_error = 1e-3});
  EXPECT_LE(phi.both.standard_error, 1e-3);
  const double p = packing.both_share();
  EXPECT_NEAR(static_cast<double>(phi.n_points), p * (1.0 - p) / 1e-6, 0.1 * p * (1.0 - p) / 1e-6);
}

TEST(PackingFraction, OpenBoxHasNoImages) {
  // A sphere of diameter 2 centred on the corner of an open box: an eighth of it is inside.
  const Box box(Vector3::Zero(), Vector3::Constant(3.0), Vector3::Zero(), {false, false, false});
  const std::vector<Vector3> nodes = {{0, 0, 0}};
  const std::vector<std::int64_t> first_node = {0, 1};
  const auto phi = packing_fraction(box, {nodes, first_node}, {}, {.n_points = 300000, .node_diameter = 2.0});
  EXPECT_NEAR(phi.both.value, pi / 6.0 / 27.0, 4.0 * phi.both.standard_error);
}

TEST(PackingFraction, ErrorDoesNotVanishInAFullBox) {
  const Box box(Vector3::Zero(), Vector3::Constant(1.0));
  const std::vector<Vector3> nodes = {{0.5, 0.5, 0.5}};
  const std::vector<std::int64_t> first_node = {0, 1};
  const auto phi = packing_fraction(box, {nodes, first_node}, {}, {.n_points = 1000, .node_diameter = 4.0});
  EXPECT_EQ(phi.both.value, 1.0);
  EXPECT_GT(phi.both.standard_error, 0.0);
}

TEST(PackingFraction, ReferenceShare) {
  EXPECT_DOUBLE_EQ(reference_packing_fraction(Box(Vector3::Zero(), {2.0, 4.0, 5.0}), std::vector{10.0, 6.0}), 0.4);
}

TEST(PackingFraction, BadOptionsAreNamed) {
  const CubePacking packing;
  const auto run = [&](const PackingFractionOptions& options) {
    packing_fraction(packing.box, packing.grains(), packing.hulls, options);
  };
  EXPECT_THROW(run({.n_points = 0}), std::invalid_argument);
  EXPECT_THROW(run({.target_error = 0.0}), std::invalid_argument);
  EXPECT_THROW(run({.node_diameter = -1.0}), std::invalid_argument);
  EXPECT_THROW(packing_fraction(packing.box, packing.grains(), std::span(packing.hulls).first(1), {}),
               std::invalid_argument);
  const std::vector<std::int64_t> wrong = {0, 8, 8, 16};
  EXPECT_THROW(GrainNodes(packing.positions, wrong), std::invalid_argument);
}

} // namespace
