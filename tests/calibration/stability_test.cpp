// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/bond_network.h"
#include "calibration/network/network_operator.h"
#include "calibration/network/stability.h"
#include "tests/calibration/test_boxes.h"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

GrainTemplate free_network(const std::vector<Vector3>& position) {
  return {position, bonds_closer_than(position, 1.5, std::nullopt), std::nullopt, 1.0};
}

std::vector<Vector3> cube(const Vector3& corner) {
  std::vector<Vector3> nodes;
  for (int n = 0; n < 8; ++n) {
    nodes.push_back(corner + Vector3(n & 1, n >> 1 & 1, n >> 2 & 1));
  }
  return nodes;
}

TEST(Rigidity, ABoxAndACubeAreRigid) {
  EXPECT_NO_THROW(require_rigid(LinearNetwork(test_box(500))));
  EXPECT_NO_THROW(require_rigid(LinearNetwork(free_network(cube({0, 0, 0})))));
}

TEST(Rigidity, TwoCubesOnAHingeAreAMechanism) {
  // They share one edge of two nodes, and no other nodes are in reach: the second cube can turn about the edge.
  auto nodes = cube({0, 0, 0});
  const auto other = cube({1, 1, 0});
  GrainTemplate hinge = free_network(nodes);
  std::vector<int> number;
  for (const Vector3& x : other) {
    const auto known = std::find(nodes.begin(), nodes.begin() + 8, x);
    number.push_back(known == nodes.begin() + 8 ? static_cast<int>(hinge.position.size())
                                                : static_cast<int>(known - nodes.begin()));
    if (known == nodes.begin() + 8) {
      hinge.position.push_back(x);
    }
  }
  for (const Bond& bond : free_network(other).bonds) {
    const int i = std::min(number[bond.i], number[bond.j]), j = std::max(number[bond.i], number[bond.j]);
    if (i >= 8 || j >= 8) {
      hinge.bonds.push_back({i, j, bond.r0});
    }
  }
  ASSERT_FALSE(floating_part(hinge));
  try {
    require_rigid(LinearNetwork(hinge));
    FAIL() << "the hinge was taken for a rigid body";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("mechanism"), std::string::npos) << error.what();
  }
}

TEST(Rigidity, AFloatingNodeIsNamed) {
  auto nodes = cube({0, 0, 0});
  nodes.push_back({2.1, 0.5, 0});
  try {
    connected_network(free_network(nodes));
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("node 8"), std::string::npos) << error.what();
  }
}

/// Largest eigenvalue of A0^-1 A1 by dense algebra on the assembled matrices, translations shifted away.
double dense_lower_limit(const LinearNetwork& network) {
  const NetworkOperator op(network);
  const int n = 3 * network.n_nodes();
  const auto dense = [&](const Matrix& matrix) {
    Eigen::MatrixXd values = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) {
      PetscInt count = 0;
      const PetscInt* columns = nullptr;
      const PetscScalar* entries = nullptr;
      MatGetRow(matrix, i, &count, &columns, &entries);
      for (PetscInt c = 0; c < count; ++c) {
        values(i, columns[c]) = entries[c];
      }
      MatRestoreRow(matrix, i, &count, &columns, &entries);
    }
    return values;
  };
  Eigen::MatrixXd a0 = dense(op.assembled_a0());
  for (int i = 0; i < n; ++i) {
    for (int j = i % 3; j < n; j += 3) {
      a0(i, j) += 1.0; // stiff springs on the mean displacement
    }
  }
  const Eigen::MatrixXd quotient = a0.ldlt().solve(dense(op.assembled_a1()));
  return -1.0 / quotient.eigenvalues().real().maxCoeff();
}

TEST(StabilityLimit, IsTheDenseEigenvalue) {
  const LinearNetwork network(test_box(160));
  EXPECT_NEAR(lower_stability_limit(network).alpha, dense_lower_limit(network), 2e-4);
}

TEST(StabilityLimit, LiesBeforeTheShearModulusVanishes) {
  const LinearNetwork network(test_box(500));
  const StabilityLimit lower = lower_stability_limit(network);
  EXPECT_LT(lower.alpha, -0.95);
  EXPECT_GT(lower.alpha, affine_shear_limit(network));
  EXPECT_NEAR(affine_shear_limit(network), -1.15, 0.06);
  EXPECT_LT(lower.participation, 0.5); // a local mode, not a shear wave
}

} // namespace
} // namespace boba::calibration
