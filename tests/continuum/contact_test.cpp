// SPDX-License-Identifier: GPL-3.0-or-later
// The condensed contact problem against an exhaustive search, and the law of the layer.
#include "continuum/contact/condensed_contact.h"
#include "continuum/elasticity/direct_solver.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <random>

namespace boba::continuum::testing {
namespace {

CondensedContact random_problem(int n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd root(n, n);
  CondensedContact problem;
  problem.overlap.resize(n);
  problem.area = Eigen::VectorXd::Ones(n);
  for (int i = 0; i < n; ++i) {
    problem.overlap[i] = normal(generator);
    problem.area[i] += 0.5 * std::abs(normal(generator));
    for (int j = 0; j < n; ++j) {
      root(i, j) = normal(generator);
    }
  }
  problem.compliance = root * root.transpose() + 0.01 * Eigen::MatrixXd::Identity(n, n);
  return problem;
}

/// The solution among all 2^n sets of pressed nodes, each solved with a full LU factorisation.
Eigen::VectorXd exhaustive(const CondensedContact& problem, double softness) {
  const int n = int(problem.area.size());
  for (int bits = 0; bits < (1 << n); ++bits) {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(n);
    for (int i = 0; i < n; ++i) {
      if (bits & (1 << i)) {
        matrix.row(i) = problem.compliance.row(i);
        matrix(i, i) += softness * problem.area[i];
        rhs[i] = problem.overlap[i];
      }
    }
    const Eigen::VectorXd p = matrix.fullPivLu().solve(rhs);
    const Eigen::VectorXd rest = problem.overlap - problem.compliance * p;
    bool right = true;
    for (int i = 0; i < n; ++i) {
      right = right && (bits & (1 << i) ? p[i] >= 0 : rest[i] <= 1e-12);
    }
    if (right) {
      return p;
    }
  }
  return {};
}

TEST(CondensedContact, FindsTheOnlySolutionWhateverTheFirstGuess) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const CondensedContact problem = random_problem(8, seed);
    const Eigen::VectorXd expected = exhaustive(problem, 0);
    ASSERT_EQ(expected.size(), 8);
    for (const bool guess : {false, true}) {
      const auto found = solve(problem, {}, std::vector<bool>(8, guess));
      EXPECT_LT((found.pressure - expected).norm(), 1e-8 * (1 + expected.norm())) << "seed " << seed;
    }
  }
}

TEST(CondensedContact, FindsTheSolutionWithALinearLayer) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const CondensedContact problem = random_problem(7, seed);
    const auto found = solve(problem, {4, 0}, std::vector<bool>(7, false));
    EXPECT_LT((found.pressure - exhaustive(problem, 0.25)).norm(), 1e-8) << "seed " << seed;
  }
}

TEST(CondensedContact, SaysSoWhenItDoesNotSettle) {
  EXPECT_THROW(solve(random_problem(8, 3), {}, std::vector<bool>(8, true), 1), NotSettled);
}

TEST(InterfaceLaw, OverlapInvertsPressure) {
  const InterfaceLaw law{2, 400};
  for (const double g : {1e-9, 1e-3, 0.1, 0.5, 3.}) {
    EXPECT_NEAR(law.overlap(2 * g + 400 * g * g * g), g, 1e-13 * g);
    const double p = law.pressure(g), step = 1e-6 * p;
    EXPECT_NEAR(law.softness(p), (law.overlap(p + step) - law.overlap(p - step)) / (2 * step), 1e-6 * law.softness(p));
  }
  EXPECT_EQ(InterfaceLaw{}.overlap(5), 0);
  EXPECT_THROW(check(InterfaceLaw{0, 1}), std::invalid_argument);
  EXPECT_THROW(check(InterfaceLaw{1, -1}), std::invalid_argument);
}

TEST(DirectSolver, CondensesLikeADenseInverse) {
  const int n = 40;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    dense(i, i) = 5;
    for (const int j : {i + 1, i + 7}) {
      if (j < n) {
        dense(i, j) = dense(j, i) = -1;
      }
    }
  }
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, 3);
  columns(3, 0) = columns(4, 0) = 1;
  columns(20, 1) = 2;
  columns(39, 2) = -1;
  DirectSolver solver;
  solver.factorise(dense.sparseView());
  const Eigen::MatrixXd expected = columns.transpose() * dense.inverse() * columns;
  EXPECT_LT((solver.condense(columns.sparseView()) - expected).norm(), 1e-13);
  EXPECT_THROW(solver.factorise(Eigen::MatrixXd::Zero(n, n).sparseView()), std::runtime_error);
}

} // namespace
} // namespace boba::continuum::testing
