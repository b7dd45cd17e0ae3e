// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/bounds.h"

#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace boba::test {
namespace {

using Eigen::Vector3d;

TEST(Bounds, ContainNothingUntilAPointIsIncluded) {
  Bounds bounds;
  EXPECT_FALSE(bounds.contains(Vector3d::Zero()));
  bounds.include({1.0, -2.0, 3.0});
  EXPECT_TRUE(bounds.contains({1.0, -2.0, 3.0}));
  EXPECT_FALSE(bounds.contains({1.0, -2.0, 3.1}));
}

TEST(Bounds, ReachFromTheLeastToTheLargestCoordinates) {
  const std::vector<Vector3d> points = {{1.0, 5.0, -1.0}, {-2.0, 4.0, 0.0}, {0.5, 7.0, 2.0}};
  const Bounds bounds = bounds_of(points);
  EXPECT_EQ(bounds.low, Vector3d(-2.0, 4.0, -1.0));
  EXPECT_EQ(bounds.high, Vector3d(1.0, 7.0, 2.0));
  EXPECT_EQ(bounds.extent(), Vector3d(3.0, 3.0, 3.0));
  EXPECT_EQ(bounds.widened(0.5).low, Vector3d(-2.5, 3.5, -1.5));
}

TEST(Bounds, DoNotContainWhatIsNoNumber) {
  const Bounds bounds{Vector3d::Constant(-1e9), Vector3d::Constant(1e9)};
  EXPECT_FALSE(bounds.contains({0.0, std::nan(""), 0.0}));
}

TEST(Bounds, OfAShearedCuboidReachAsFarAsItsCorners) {
  const Bounds unit{Vector3d::Zero(), Vector3d::Ones()};
  const Bounds sheared = unit.mapped([](const Vector3d& x) { return Vector3d(x[0] + 2.0 * x[1], -x[1], x[2]); });
  EXPECT_EQ(sheared.low, Vector3d(0.0, -1.0, 0.0));
  EXPECT_EQ(sheared.high, Vector3d(3.0, 0.0, 1.0));
}

} // namespace
} // namespace boba::test
