// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/philox.h"
#include "bpm/measure/scattering.h"
#include "tests/support/shapes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <omp.h>
#include <set>
#include <stdexcept>

namespace {

using namespace boba;
using namespace boba::measure;
using std::numbers::pi;

/// Grains of 1, 33 and 300 nodes in a tilted cell, not wrapped into it.
struct ThreeGrains {
  Box box{{-1.0, 2.0, 3.0}, {9.0, 8.0, 11.0}, {4.0, -3.0, 2.5}};
  std::vector<Vector3> positions;
  std::vector<std::int64_t> first_node{0};

  ThreeGrains() {
    for (const int n : {1, 33, 300}) {
      for (const Vector3& x : shapes::ball(n, 3.0, n)) {
        positions.push_back(x + Vector3(4.0 * n, -7.0, 1.0));
      }
      first_node.push_back(static_cast<std::int64_t>(positions.size()));
    }
  }
  GrainNodes grains() const { return {positions, first_node}; }
};

TEST(ReciprocalLattice, HoldsEachPairOfOppositeVectorsOnceUpToQMax) {
  const Box box(Vector3::Zero(), {9.0, 8.0, 11.0}, {4.0, -3.0, 2.5});
  constexpr double q_max = 4.0;
  const ReciprocalLattice lattice(box, q_max);
  std::set<std::array<int, 3>> seen;
  for (const ReciprocalRow& row : lattice.rows()) {
    EXPECT_EQ(row.first, static_cast<std::int64_t>(seen.size()));
    for (int n3 = row.low; n3 <= row.high; ++n3) {
      const Vector3 q = lattice.q(row.n1, row.n2, n3);
      EXPECT_LE(q.norm(), q_max * (1.0 + 1e-12));
      // q is a reciprocal vector: its products with a, b, c are whole turns.
      const Vector3 turns = box.h().transpose() * q / (2.0 * pi);
      EXPECT_NEAR((turns - Vector3(row.n1, row.n2, n3)).norm(), 0.0, 1e-9);
      EXPECT_TRUE(seen.insert({row.n1, row.n2, n3}).second);
      EXPECT_FALSE(seen.contains({-row.n1, -row.n2, -n3}));
    }
  }
  std::int64_t expected = 0;
  const Matrix3 b = 2.0 * pi * box.h().inverse().transpose();
  for (int n1 = -15; n1 <= 15; ++n1) {
    for (int n2 = -15; n2 <= 15; ++n2) {
      for (int n3 = -15; n3 <= 15; ++n3) {
        expected += (b * Vector3(n1, n2, n3)).norm() <= q_max;
      }
    }
  }
  EXPECT_EQ(2 * lattice.n_vectors() + 1, expected);
}

TEST(Scattering, BothWaysGiveTheSumsByDefinition) {
  const ThreeGrains packing;
  const ReciprocalLattice lattice(packing.box, 5.0);
  const auto summed = summed_amplitudes(packing.box, packing.grains(), lattice);
  const auto transformed = transformed_amplitudes(packing.box, packing.grains(), lattice);
  double worst_sum = 0.0, worst_transform = 0.0;
  for (const ReciprocalRow& row : lattice.rows()) {
    for (int n3 = row.low; n3 <= row.high; ++n3) {
      const Vector3 q = lattice.q(row.n1, row.n2, n3);
      double form_factor = 0.0;
      for (int g = 0; g < 3; ++g) {
        form_factor += direct_intensity(packing.grains().nodes_of(g), q) / 3.0;
      }
      const double intensity = direct_intensity(packing.positions, q);
      const std::int64_t v = row.first + n3 - row.low;
      worst_sum = std::max(
          {worst_sum, std::abs(summed.form_factor[v] - form_factor), std::abs(summed.intensity[v] - intensity)});
      worst_transform = std::max({worst_transform, std::abs(transformed.form_factor[v] - form_factor),
                                  std::abs(transformed.intensity[v] - intensity)});
    }
  }
  EXPECT_GT(lattice.n_vectors(), 500);
  EXPECT_LT(worst_sum, 1e-10);
  EXPECT_LT(worst_transform, 1e-9); // of values around 1: twice the relative error of an amplitude, and more at peaks
}

/// The transform's error does not depend on q: the deconvolution of its kernel is largest at the largest n.
TEST(Scattering, TransformIsAccurateUpToTheEdgeOfTheLattice) {
  const auto nodes = shapes::ball(400, 4.0, 11);
  const std::vector<std::int64_t> first_node = {0, 400};
  const Box box({3.0, -2.0, 0.5}, {15.0, 12.0, 14.0}, {-6.0, 5.0, 3.0});
  const ReciprocalLattice lattice(box, 6.0);
  const auto exact = summed_amplitudes(box, {nodes, first_node}, lattice);
  const auto fast = transformed_amplitudes(box, {nodes, first_node}, lattice);
  double worst_low = 0.0, worst_high = 0.0, mean = 0.0;
  for (const ReciprocalRow& row : lattice.rows()) {
    for (int n3 = row.low; n3 <= row.high; ++n3) {
      const std::int64_t v = row.first + n3 - row.low;
      const double error = std::abs(std::sqrt(exact.intensity[v]) - std::sqrt(fast.intensity[v]));
      double& worst = lattice.q(row.n1, row.n2, n3).norm() > 5.5 ? worst_high : worst_low;
      worst = std::max(worst, error);
      mean += exact.intensity[v] / static_cast<double>(lattice.n_vectors());
    }
  }
  EXPECT_LT(worst_low, 1e-10 * std::sqrt(mean));
  EXPECT_LT(worst_high, 1e-10 * std::sqrt(mean));
}

TEST(Scattering, EquivalentCellsOfOneLatticeGiveTheSameCurves) {
  const ThreeGrains packing;
  Matrix3 h = packing.box.h();
  h.col(1) += h.col(0); // b + a, and c - b: other vectors, same lattice
  h.col(2) -= packing.box.h().col(1);
  const Box other({50.0, -20.0, 7.0}, h.diagonal(), {h(0, 1), h(0, 2), h(1, 2)});
  const auto one = scattering(packing.box, packing.grains(), {.q_max = 5.0});
  const auto two = scattering(other, packing.grains(), {.q_max = 5.0});
  ASSERT_EQ(one.size(), two.size());
  ASSERT_GT(one.size(), 4u);
  for (std::size_t s = 0; s < one.size(); ++s) {
    EXPECT_EQ(one[s].n_vectors, two[s].n_vectors);
    EXPECT_NEAR(one[s].q, two[s].q, 1e-12);
    EXPECT_NEAR(one[s].intensity, two[s].intensity, 1e-10);
    EXPECT_NEAR(one[s].form_factor, two[s].form_factor, 1e-10);
    EXPECT_NEAR(one[s].structure, two[s].structure, 1e-10);
  }
}

TEST(Scattering, OneGrainHasStructureFactorOne) {
  const auto nodes = shapes::ball(200, 3.0, 5);
  const std::vector<std::int64_t> first_node = {0, 200};
  const Box box(Vector3::Zero(), Vector3::Constant(10.0));
  for (const ScatteringShell& shell : scattering(box, {nodes, first_node}, {.q_max = 4.0})) {
    EXPECT_NEAR(shell.structure, 1.0, 1e-12);
  }
}

TEST(Scattering, SimpleCubicPointsHaveBraggPeaksOnly) {
  std::vector<Vector3> nodes;
  std::vector<std::int64_t> first_node = {0};
  for (int i = 0; i < 64; ++i) {
    nodes.emplace_back(i % 4, i / 4 % 4, i / 16);
    first_node.push_back(i + 1);
  }
  const Box box(Vector3::Zero(), Vector3::Constant(4.0));
  const ReciprocalLattice lattice(box, 2.0 * pi * 1.1);
  const auto amplitudes = scattering_amplitudes(box, {nodes, first_node}, lattice);
  int peaks = 0;
  for (const ReciprocalRow& row : lattice.rows()) {
    for (int n3 = row.low; n3 <= row.high; ++n3) {
      const bool peak = row.n1 % 4 == 0 && row.n2 % 4 == 0 && n3 % 4 == 0;
      peaks += peak;
      EXPECT_NEAR(amplitudes.intensity[row.first + n3 - row.low], peak ? 64.0 : 0.0, 1e-10);
      EXPECT_NEAR(amplitudes.form_factor[row.first + n3 - row.low], 1.0, 1e-12);
    }
  }
  EXPECT_EQ(peaks, 3); // (1,0,0), (0,1,0), (0,0,1) and their opposites
}

TEST(Scattering, BallFormFactorHasItsKnownZerosAndLimits) {
  EXPECT_DOUBLE_EQ(ball_form_factor(0.0, 10.0), 1.0);
  EXPECT_NEAR(ball_form_factor(0.01 / 10.0 * (1.0 - 1e-9), 10.0), ball_form_factor(0.01 / 10.0 * (1.0 + 1e-9), 10.0),
              1e-8);
  for (const double zero : {4.4934, 7.7253, 10.9041}) { // tan x = x
    EXPECT_LT(ball_form_factor(zero / 10.0, 10.0), 1e-9);
    EXPECT_GT(ball_form_factor((zero + 0.1) / 10.0, 10.0), 1e-6);
  }
}

/// A ball of radius 10 filled with a fine grid of nodes: uniform for all q far below 2 pi / 0.5.
std::vector<Vector3> fine_ball() {
  std::vector<Vector3> nodes;
  for (int i = -20; i < 20; ++i) {
    for (int j = -20; j < 20; ++j) {
      for (int k = -20; k < 20; ++k) {
        const Vector3 x = 0.5 * Vector3(i + 0.5, j + 0.5, k + 0.5);
        if (x.norm() < 10.0) {
          nodes.push_back(x);
        }
      }
    }
  }
  return nodes;
}

TEST(Scattering, FilledBallHasTheFormFactorOfABall) {
  const auto nodes = fine_ball();
  const double n = static_cast<double>(nodes.size());
  // The grid's ball has its own volume, hence its own radius.
  const double radius = std::cbrt(3.0 * n * 0.125 / (4.0 * pi));
  const std::vector<std::int64_t> first_node = {0, static_cast<std::int64_t>(nodes.size())};
  const Box box(Vector3::Zero(), {37.0, 41.0, 43.0}, {5.0, 11.0, -9.0});
  const ReciprocalLattice lattice(box, 1.2);
  const auto amplitudes = scattering_amplitudes(box, {nodes, first_node}, lattice);
  for (const ReciprocalRow& row : lattice.rows()) {
    for (int n3 = row.low; n3 <= row.high; ++n3) {
      const double q = lattice.q(row.n1, row.n2, n3).norm();
      EXPECT_NEAR(amplitudes.form_factor[row.first + n3 - row.low] / n, ball_form_factor(q, radius), 2e-4);
    }
  }
  // First zero: the minimum of the measured curve, in some direction.
  const Vector3 direction = Vector3(1.0, 2.0, -0.4).normalized();
  double lowest = 1.0, lowest_q = 0.0;
  for (int k = 0; k < 100; ++k) {
    const double q = 0.40 + 0.001 * k;
    const double value = direct_intensity(nodes, q * direction) / n;
    if (value < lowest) {
      lowest = value;
      lowest_q = q;
    }
  }
  EXPECT_NEAR(lowest_q * radius, 4.4934, 0.02);
}

TEST(Scattering, FormFactorGoesFromTheNumberOfNodesToOne) {
  const auto nodes = shapes::ball(4000, 10.0, 11);
  const std::vector<std::int64_t> first_node = {0, 4000};
  // Smallest q R = 0.063: P/N = 1 - (qR)^2/5 = 0.9992.
  const auto low = scattering(Box(Vector3::Zero(), Vector3::Constant(1000.0)), {nodes, first_node}, {.q_max = 0.0063});
  ASSERT_EQ(low.size(), 1u);
  EXPECT_NEAR(low[0].form_factor / 4000.0, ball_form_factor(low[0].q, 10.0), 1e-4);
  EXPECT_NEAR(low[0].form_factor / 4000.0, 1.0, 1e-3);
  // Without order among nodes the far end is 1; each vector scatters by 1, and there are thousands.
  const ReciprocalLattice lattice(Box(Vector3::Zero(), Vector3::Constant(21.0)), 6.0);
  const auto high = scattering_amplitudes(Box(Vector3::Zero(), Vector3::Constant(21.0)), {nodes, first_node}, lattice);
  double sum = 0.0;
  int count = 0;
  for (const ReciprocalRow& row : lattice.rows()) {
    for (int n3 = row.low; n3 <= row.high; ++n3) {
      if (lattice.q(row.n1, row.n2, n3).norm() > 4.0) {
        sum += high.form_factor[row.first + n3 - row.low];
        ++count;
      }
    }
  }
  ASSERT_GT(count, 5000);
  EXPECT_NEAR(sum / count, 1.0, 0.06);
}

TEST(Scattering, SameForAnyNumberOfThreads) {
  const ThreeGrains packing;
  const ReciprocalLattice lattice(packing.box, 3.0);
  const int before = omp_get_max_threads();
  omp_set_num_threads(1);
  const auto one = scattering_amplitudes(packing.box, packing.grains(), lattice);
  omp_set_num_threads(4);
  const auto four = scattering_amplitudes(packing.box, packing.grains(), lattice);
  omp_set_num_threads(before);
  EXPECT_EQ(one.intensity, four.intensity);
  EXPECT_EQ(one.form_factor, four.form_factor);
}

TEST(Scattering, BadInputIsNamed) {
  const ThreeGrains packing;
  EXPECT_THROW(scattering(packing.box, packing.grains(), {.q_max = 0.0}), std::invalid_argument);
  EXPECT_THROW(scattering(packing.box, packing.grains(), {.q_max = 1e6}), std::invalid_argument);
  EXPECT_THROW(scattering(packing.box, packing.grains(), {.q_max = 1.0, .shell_width = -1.0}), std::invalid_argument);
  const Box open(Vector3::Zero(), Vector3::Constant(20.0), Vector3::Zero(), {true, true, false});
  EXPECT_THROW(scattering(open, packing.grains(), {.q_max = 1.0}), std::invalid_argument);
}

} // namespace
