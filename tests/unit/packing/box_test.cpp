// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/box.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <stdexcept>

namespace boba::test {
namespace {

const Box tilted({0.5, -1.0, 2.0}, {4.0, 5.0, 6.0}, {1.5, -1.0, 2.0});

TEST(Box, HoldsItsVectorsInColumns) {
  Matrix3 h;
  h << 4.0, 1.5, -1.0, 0.0, 5.0, 2.0, 0.0, 0.0, 6.0;
  EXPECT_EQ(tilted.h(), h);
  EXPECT_DOUBLE_EQ(tilted.volume(), h.determinant());
  EXPECT_TRUE((tilted.h_inverse() * h).isApprox(Matrix3::Identity(), 1e-15));
}

TEST(Box, FractionalCoordinatesGoThereAndBack) {
  const Vector3 x(3.0, -7.0, 11.0);
  EXPECT_TRUE(tilted.to_position(tilted.to_fractional(x)).isApprox(x, 1e-14));
  EXPECT_TRUE(tilted.to_fractional(tilted.origin()).isZero());
  EXPECT_TRUE(tilted.to_fractional(tilted.origin() + tilted.h().col(2)).isApprox(Vector3(0.0, 0.0, 1.0), 1e-15));
}

TEST(Box, WrapsIntoTheCellAlongPeriodicDirectionsAlone) {
  const Vector3 inside = tilted.to_position({0.25, 0.5, 0.75});
  const Vector3 image = inside + tilted.h() * Vector3(2.0, -3.0, 1.0);
  EXPECT_EQ(tilted.image_of(image), Eigen::Vector3i(2, -3, 1));
  EXPECT_TRUE(tilted.wrapped(image).isApprox(inside, 1e-14));
  const Box slab({0.0, 0.0, 0.0}, {4.0, 5.0, 6.0}, Vector3::Zero(), {true, false, true});
  EXPECT_EQ(slab.image_of({9.0, 9.0, -1.0}), Eigen::Vector3i(2, 0, -1));
}

// Against a search over all images around.
TEST(Box, MinimumImageIsTheNearestWhereItIsShort) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-20.0, 20.0);
  const double reach = 0.5 * tilted.face_distances().minCoeff();
  for (int trial = 0; trial < 2000; ++trial) {
    const Vector3 difference(coordinate(random), coordinate(random), coordinate(random));
    double nearest = 1e300;
    for (int i = -12; i <= 12; ++i) {
      for (int j = -8; j <= 8; ++j) {
        for (int k = -6; k <= 6; ++k) {
          nearest = std::min(nearest, (difference - tilted.h() * Vector3(i, j, k)).norm());
        }
      }
    }
    const double found = tilted.minimum_image(difference).norm();
    if (nearest < reach || found < reach) {
      EXPECT_NEAR(found, nearest, 1e-12);
    }
  }
}

TEST(Box, FaceDistancesAreVolumeOverArea) {
  const Vector3 a = tilted.h().col(0), b = tilted.h().col(1), c = tilted.h().col(2);
  const Vector3 d = tilted.face_distances();
  EXPECT_NEAR(d[0], tilted.volume() / b.cross(c).norm(), 1e-14);
  EXPECT_NEAR(d[1], tilted.volume() / c.cross(a).norm(), 1e-14);
  EXPECT_NEAR(d[2], tilted.volume() / a.cross(b).norm(), 1e-14);
}

TEST(Box, FlipKeepsTheLattice) {
  Box box({0.0, 0.0, 0.0}, {4.0, 5.0, 6.0}, {2.7, -3.1, 4.4});
  const Matrix3 before = box.h();
  EXPECT_TRUE(box.flip());
  EXPECT_LE(std::abs(box.xy()), 2.0);
  EXPECT_LE(std::abs(box.xz()), 2.0);
  EXPECT_LE(std::abs(box.yz()), 2.5);
  // Old cell vectors in units of the new ones are whole numbers, with determinant 1: the same lattice.
  const Matrix3 change = box.h().inverse() * before;
  EXPECT_TRUE(change.isApprox(change.array().round().matrix(), 1e-12));
  EXPECT_NEAR(change.determinant(), 1.0, 1e-12);
  EXPECT_FALSE(box.flip());
}

TEST(Box, IsNotFlippedAlongOpenDirections) {
  Box box({0.0, 0.0, 0.0}, {4.0, 5.0, 6.0}, {2.7, 0.0, 0.0}, {false, true, true});
  EXPECT_FALSE(box.flip());
  EXPECT_DOUBLE_EQ(box.xy(), 2.7);
}

TEST(Box, RefusesLengthsThatAreNone) {
  for (const double length : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(Box(Vector3::Zero(), {1.0, length, 1.0}), std::invalid_argument);
  }
}

} // namespace
} // namespace boba::test
