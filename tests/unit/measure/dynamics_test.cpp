// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/blocking.h"
#include "bpm/measure/non_affine.h"
#include "tests/support/crystals.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <stdexcept>

namespace {

using namespace boba;
using namespace boba::measure;

/// x_{t+1} = rho x_t + noise, unit variance: the mean of n values has variance (1 + rho) / (1 - rho) / n.
std::vector<double> correlated_series(int n, double rho, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<double> series(n);
  double x = normal(generator);
  for (double& value : series) {
    value = x;
    x = rho * x + std::sqrt(1.0 - rho * rho) * normal(generator);
  }
  return series;
}

TEST(Blocking, IndependentValuesKeepTheirNaiveError) {
  const BlockedMean mean = blocked_mean(correlated_series(1 << 14, 0.0, 1));
  EXPECT_TRUE(mean.reached_plateau);
  EXPECT_NEAR(mean.standard_error * 128.0, 1.0, 0.1); // 1 / sqrt(n)
}

TEST(Blocking, CorrelatedValuesGetTheirKnownError) {
  constexpr double rho = 0.9;
  constexpr int n_series = 30;
  const double expected = std::sqrt((1.0 + rho) / (1.0 - rho)) / 256.0;
  double ratio = 0.0;
  for (unsigned seed = 0; seed < n_series; ++seed) {
    const BlockedMean mean = blocked_mean(correlated_series(1 << 16, rho, 2 + seed));
    EXPECT_TRUE(mean.reached_plateau);
    EXPECT_NEAR(mean.naive_error * 256.0, 1.0, 0.1);
    ratio += mean.standard_error / expected / n_series;
  }
  // 128 blocks of 512: one error is known to 1/sqrt(256) = 6 %, the mean of 30 to 1.1 %; blocks of 512 lose 1 %.
  EXPECT_NEAR(ratio, 1.0, 0.045);
}

TEST(Blocking, StatedErrorCoversTheTruth) {
  int covered = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const BlockedMean mean = blocked_mean(correlated_series(4096, 0.8, 1000 + seed));
    covered += std::abs(mean.mean) < 1.96 * mean.standard_error;
  }
  // 190 expected of an exact error; that of a finite series is itself uncertain by some per cent.
  EXPECT_GE(covered, 178);
  EXPECT_LE(covered, 199);
}

TEST(Blocking, TooShortASeriesSaysSo) {
  EXPECT_FALSE(blocked_mean(correlated_series(64, 0.99, 3)).reached_plateau);
  EXPECT_FALSE(blocked_mean(std::vector{1.0, 2.0}).reached_plateau);
  EXPECT_DOUBLE_EQ(blocked_mean(std::vector{1.0, 2.0}).standard_error, 0.5);
  EXPECT_THROW(blocked_mean(std::vector{1.0}), std::invalid_argument);
  EXPECT_THROW(blocked_mean(std::vector{1.0, std::numeric_limits<double>::infinity()}), std::invalid_argument);
}

TEST(Blocking, WindowTakesOnlyWhatLiesInside) {
  const std::vector<double> strain = {0.5, 1.0, 1.5, 2.0, 4.9, 5.0, 6.0}, mu = {9.0, 9.0, 1.0, 2.0, 3.0, 9.0, 9.0};
  const BlockedMean mean = blocked_mean_in_window(strain, mu, 1.0, 5.0);
  EXPECT_EQ(mean.n_values, 3);
  EXPECT_DOUBLE_EQ(mean.mean, 2.0);
  EXPECT_THROW(blocked_mean_in_window(strain, mu, 7.0, 8.0), std::invalid_argument);
}

/// A cell that is compressed and sheared at once and flipped whenever it can be, with points carried along or not.
struct Flow {
  Box box{{1.0, 2.0, 3.0}, {10.0, 8.0, 9.0}, {1.0, -2.0, 3.0}};
  std::vector<Vector3> centres;
  double strain_step = 0.0;

  Flow() {
    for (const Vector3& x : crystals::gas(50, 1.0, 3).centres) {
      centres.push_back(box.origin() + 4.0 * x); // far outside the cell too
    }
  }
  void step(double strain, double growth) {
    strain_step = strain;
    Matrix3 f = growth * Matrix3::Identity();
    f(0, 1) = growth * strain;
    for (Vector3& x : centres) {
      x = box.origin() + f * (x - box.origin());
    }
    box.set_h(f * box.h());
    box.flip();
  }
};

TEST(NonAffine, BoxFlowLeavesNothingThroughFlips) {
  Flow flow;
  NonAffineMotion motion(flow.box, flow.centres);
  for (int i = 0; i < 60; ++i) {
    flow.step(0.11, 0.998);
    motion.add(flow.box, flow.centres, flow.strain_step);
  }
  EXPECT_LT(motion.mean_square(), 1e-18);
}

TEST(NonAffine, LargeStepsAreFollowedByTheirStrain) {
  Flow flow;
  NonAffineMotion motion(flow.box, flow.centres);
  for (int i = 0; i < 5; ++i) {
    flow.step(2.3, 1.001);
    motion.add(flow.box, flow.centres, flow.strain_step);
  }
  EXPECT_LT(motion.mean_square(), 1e-18);
}

TEST(NonAffine, AddedStepsAreFoundAndACommonDriftIsNot) {
  Flow flow;
  NonAffineMotion motion(flow.box, flow.centres);
  std::vector<Vector3> walked(flow.centres.size(), Vector3::Zero());
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal(0.0, 0.3);
  for (int i = 0; i < 20; ++i) {
    flow.step(0.05, 1.0);
    for (std::size_t g = 0; g < walked.size(); ++g) {
      const Vector3 step(normal(generator), normal(generator), normal(generator));
      walked[g] += step;
      flow.centres[g] += step + Vector3(1.0, -1.0, 0.5);
    }
    motion.add(flow.box, flow.centres, flow.strain_step);
  }
  Vector3 mean = Vector3::Zero();
  for (const Vector3& u : walked) {
    mean += u / static_cast<double>(walked.size());
  }
  double expected = 0.0;
  for (const Vector3& u : walked) {
    expected += (u - mean).squaredNorm() / static_cast<double>(walked.size());
  }
  EXPECT_NEAR(motion.mean_square(), expected, 1e-9);
}

TEST(NonAffine, MinimalNonAffinityIgnoresUniformStrain) {
  const auto crystal = crystals::fcc(3);
  const NeighbourLists neighbours = solid_angle_neighbours(crystal.box, crystal.centres);
  Matrix3 f;
  f << 1.1, 0.3, 0.0, -0.1, 0.9, 0.2, 0.0, 0.1, 1.0;
  std::vector<std::vector<Vector3>> change(neighbours.size());
  for (std::size_t g = 0; g < neighbours.size(); ++g) {
    for (const Neighbour& n : neighbours[g]) {
      change[g].push_back((f - Matrix3::Identity()) * n.vector);
    }
  }
  for (const double d2 : minimal_non_affinity(neighbours, change)) {
    EXPECT_NEAR(d2, 0.0, 1e-20);
  }
  // One neighbour of twelve moves away by 0.1. In fcc sum d d^T = 4 I, so F takes up delta d^T / 4 and leaves
  // |delta|^2 (1 - |d|^2 / 4) / 12 with |d| = 1.
  change[0][3] += Vector3(0.0, 0.0, 0.1);
  EXPECT_NEAR(minimal_non_affinity(neighbours, change)[0], 0.01 * (1.0 - 0.25) / 12.0, 1e-12);
}

TEST(NonAffine, NeighbourDisplacementsFollowPeriodicCopiesThroughAFlip) {
  Flow flow;
  for (int i = 0; i < 3; ++i) {
    const Box before = flow.box;
    const std::vector<Vector3> centres = flow.centres;
    const NeighbourLists neighbours = solid_angle_neighbours(before, centres);
    flow.step(0.6, 0.99); // more than half a cell: flips
    const Matrix3 f = deformation_gradient(before, flow.box, 0.6);
    for (const double d2 :
         minimal_non_affinity(neighbours, neighbour_displacements(neighbours, centres, flow.centres, f))) {
      EXPECT_LT(d2, 1e-18);
    }
    // An affine map takes each neighbour vector to F d.
    const auto change = neighbour_displacements(neighbours, centres, flow.centres, f);
    const Vector3 d = neighbours[7][0].vector;
    EXPECT_NEAR((d + change[7][0] - f * d).norm(), 0.0, 1e-9);
  }
}

TEST(NonAffine, NeighbourChangesCountBothSides) {
  const NeighbourLists before = {
      {{1, Vector3::UnitX()}, {2, Vector3::UnitY()}, {2, -Vector3::UnitY()}}, {{0}}, {{0}, {0}}};
  const NeighbourLists after = {{{2, Vector3::UnitY()}, {1, Vector3::UnitX()}}, {{0}}, {{0}, {1}}};
  const NeighbourChanges changes = neighbour_changes(before, after);
  EXPECT_EQ(changes.lost, (std::vector{1, 0, 1}));
  EXPECT_EQ(changes.gained, (std::vector{0, 0, 1}));
  EXPECT_EQ(changes.n_grains_changed, 2);
  EXPECT_THROW(neighbour_changes(before, NeighbourLists(2)), std::invalid_argument);
}

} // namespace
