// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/stable_step.h"
#include "bpm/grain/random.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <gtest/gtest.h>

namespace boba {
namespace {

TEST(StableStep, DumbbellInClosedForm) {
  // One bond: stretching has w^2 = 2 k / m and c = 2 gamma / m; the many-body term cancels. dt^2 + 2 dt = 2.
  GrainTemplate grain;
  grain.position = {{-0.5, 0, 0}, {0.5, 0, 0}};
  grain.bonds = {{0, 1, 1.0}};
  for (const double alpha : {0.0, 5.0}) {
    EXPECT_NEAR(stable_step(grain, {}, alpha), std::sqrt(3.0) - 1.0, 1e-12);
  }
  Material undamped;
  undamped.gamma = 0.0;
  EXPECT_NEAR(stable_step(grain, undamped, 0.0), std::sqrt(2.0), 1e-12);
}

TEST(StableStep, RefusesATemplateWithoutBonds) {
  GrainTemplate grain;
  grain.position = {{0, 0, 0}};
  EXPECT_THROW(stable_step(grain, {}, 0.0), std::invalid_argument);
}

/// A cloud of nodes, all pairs closer than 1.5 d bonded.
GrainTemplate cloud() {
  Random random(5);
  GrainTemplate grain;
  while (grain.position.size() < 24) {
    const Eigen::Vector3d x = random.vector(1.4);
    bool free = true;
    for (const Eigen::Vector3d& y : grain.position) {
      free = free && (x - y).norm() > 0.75;
    }
    if (free) {
      grain.position.push_back(x);
    }
  }
  for (int i = 0; i < grain.n_nodes(); ++i) {
    for (int j = i + 1; j < grain.n_nodes(); ++j) {
      const double r = (grain.position[i] - grain.position[j]).norm();
      if (r < 1.5) {
        grain.bonds.push_back({i, j, r});
      }
    }
  }
  return grain;
}

/// The bond law as docs/notation.md writes it, without damping.
Eigen::VectorXd bond_forces(const GrainTemplate& grain, const Eigen::VectorXd& x, double alpha) {
  const int n = grain.n_nodes();
  std::vector<double> v(n, 0.0), v0(n, 0.0);
  const auto difference = [&x](const Bond& b) -> Eigen::Vector3d {
    return x.segment<3>(3 * b.i) - x.segment<3>(3 * b.j);
  };
  for (const Bond& b : grain.bonds) {
    for (const int node : {b.i, b.j}) {
      v[node] += std::pow(difference(b).norm(), 3);
      v0[node] += std::pow(b.r0, 3);
    }
  }
  Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * n);
  for (const Bond& b : grain.bonds) {
    const double r = difference(b).norm();
    const double f = (b.r0 - r) + alpha * (std::cbrt((v[b.i] + v[b.j]) / (v0[b.i] + v0[b.j])) - r / b.r0);
    force.segment<3>(3 * b.i) += f / r * difference(b);
    force.segment<3>(3 * b.j) -= f / r * difference(b);
  }
  return force;
}

/// Minus the derivative of the forces at rest, by central differences.
Eigen::MatrixXd stiffness_of(const GrainTemplate& grain, double alpha) {
  Eigen::VectorXd x(3 * grain.n_nodes());
  for (int i = 0; i < grain.n_nodes(); ++i) {
    x.segment<3>(3 * i) = grain.position[i];
  }
  Eigen::MatrixXd stiffness(x.size(), x.size());
  const double h = 1e-5;
  for (int c = 0; c < x.size(); ++c) {
    Eigen::VectorXd up = x, down = x;
    up[c] += h;
    down[c] -= h;
    stiffness.col(c) = -(bond_forces(grain, up, alpha) - bond_forces(grain, down, alpha)) / (2.0 * h);
  }
  return stiffness;
}

/// Damping of a bond: -gamma e (e . v) on its first end, for gamma = 1.
Eigen::MatrixXd damping_of(const GrainTemplate& grain) {
  Eigen::MatrixXd damping = Eigen::MatrixXd::Zero(3 * grain.n_nodes(), 3 * grain.n_nodes());
  for (const Bond& b : grain.bonds) {
    const Eigen::Vector3d e = (grain.position[b.i] - grain.position[b.j]).normalized();
    const Eigen::Matrix3d outer = e * e.transpose();
    damping.block<3, 3>(3 * b.i, 3 * b.i) += outer;
    damping.block<3, 3>(3 * b.j, 3 * b.j) += outer;
    damping.block<3, 3>(3 * b.i, 3 * b.j) -= outer;
    damping.block<3, 3>(3 * b.j, 3 * b.i) -= outer;
  }
  return damping;
}

/// Largest growth in one step of the scheme v' = v - dt (A x + C v), x' = x + dt v'.
double growth(const Eigen::MatrixXd& a, const Eigen::MatrixXd& c, double dt) {
  const auto n = a.rows();
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd map(2 * n, 2 * n);
  map << one - dt * dt * a, dt * (one - dt * c), -dt * a, one - dt * c;
  return Eigen::EigenSolver<Eigen::MatrixXd>(map, false).eigenvalues().cwiseAbs().maxCoeff();
}

TEST(StableStep, IsWhereTheOneStepMapBeginsToGrow) {
  const GrainTemplate grain = cloud();
  const Eigen::MatrixXd c = damping_of(grain);
  for (const double alpha : {-0.8, 0.0, 2.0, 20.0}) {
    const Eigen::MatrixXd a = stiffness_of(grain, alpha);
    const double dt = stable_step(grain, {}, alpha);
    // Rigid motions have the factor 1 twice, which rounding splits by the square root of its size.
    EXPECT_LT(growth(a, c, 0.999 * dt), 1.0 + 1e-5) << alpha;
    EXPECT_GT(growth(a, c, 1.001 * dt), 1.0005) << alpha;
  }
}

TEST(StableStep, WithoutDampingIsThatOfTheLargestFrequency) {
  const GrainTemplate grain = cloud();
  Material undamped;
  undamped.gamma = 0.0;
  for (const double alpha : {-0.8, 0.0, 2.0, 12.0}) {
    const Eigen::VectorXcd w2 = Eigen::EigenSolver<Eigen::MatrixXd>(stiffness_of(grain, alpha), false).eigenvalues();
    const double dt = 2.0 / std::sqrt(w2.cwiseAbs().maxCoeff());
    EXPECT_NEAR(stable_step(grain, undamped, alpha), dt, 1e-4 * dt) << alpha;
  }
}

TEST(StableStep, OfAPackingIsThatOfItsStiffestGrain) {
  Packing packing;
  packing.templates = {std::make_shared<const GrainTemplate>(cloud())};
  for (const double alpha : {0.0, 12.0, -0.5, 5.0}) {
    packing.grains.push_back({.alpha = alpha});
  }
  const std::optional<PackingStep> step = stable_step(packing, {});
  ASSERT_TRUE(step);
  EXPECT_EQ(step->alpha, 12.0);
  EXPECT_EQ(step->dt, stable_step(*packing.templates[0], {}, 12.0));
  auto single = std::make_shared<GrainTemplate>();
  single->position = {{0, 0, 0}};
  packing.templates = {single};
  EXPECT_FALSE(stable_step(packing, {}));
}

} // namespace
} // namespace boba
