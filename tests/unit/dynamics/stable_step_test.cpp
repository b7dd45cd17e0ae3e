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

TEST(StableStep, AgreesWithTheSpectrumOfTheForceLaw) {
  // Without damping dt = 2 / w, w^2 the largest eigenvalue of the forces' finite-difference Jacobian.
  const GrainTemplate grain = cloud();
  Eigen::VectorXd x(3 * grain.n_nodes());
  for (int i = 0; i < grain.n_nodes(); ++i) {
    x.segment<3>(3 * i) = grain.position[i];
  }
  Material undamped;
  undamped.gamma = 0.0;
  for (const double alpha : {-0.8, 0.0, 2.0, 12.0}) {
    Eigen::MatrixXd jacobian(x.size(), x.size());
    const double h = 1e-5;
    for (int c = 0; c < x.size(); ++c) {
      Eigen::VectorXd up = x, down = x;
      up[c] += h;
      down[c] -= h;
      jacobian.col(c) = -(bond_forces(grain, up, alpha) - bond_forces(grain, down, alpha)) / (2.0 * h);
    }
    const double w2 = Eigen::EigenSolver<Eigen::MatrixXd>(jacobian, false).eigenvalues().cwiseAbs().maxCoeff();
    EXPECT_NEAR(stable_step(grain, undamped, alpha), 2.0 / std::sqrt(w2), 0.01 * 2.0 / std::sqrt(w2)) << alpha;
  }
}

} // namespace
} // namespace boba
