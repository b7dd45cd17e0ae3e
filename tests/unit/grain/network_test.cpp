// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/bond_network.h"

#include <gtest/gtest.h>

namespace boba {
namespace {

using Eigen::Vector3d;

GrainTemplate network(const std::vector<Vector3d>& position) {
  return {position, bonds_closer_than(position, 1.5, std::nullopt), std::nullopt, 1.0};
}

std::vector<Vector3d> cube(const Vector3d& corner) {
  std::vector<Vector3d> nodes;
  for (int n = 0; n < 8; ++n) {
    nodes.push_back(corner + Vector3d(n & 1, n >> 1 & 1, n >> 2 & 1));
  }
  return nodes;
}

TEST(BondNetwork, JoinsEdgesAndFaceDiagonalsOfAUnitCube) {
  const auto grain = network(cube({0, 0, 0}));
  EXPECT_EQ(grain.bonds.size(), 12u + 12u); // 1 and sqrt(2), not sqrt(3)
  for (const Bond& bond : grain.bonds) {
    EXPECT_LT(bond.i, bond.j);
    EXPECT_DOUBLE_EQ(bond.r0, (grain.position[bond.i] - grain.position[bond.j]).norm());
  }
  EXPECT_FALSE(floating_part(grain));
}

TEST(BondNetwork, ANodeOnTwoBondsFloats) {
  auto nodes = cube({0, 0, 0});
  nodes.push_back({2.1, 0.5, 0}); // reaches two corners only
  const auto reason = floating_part(network(nodes));
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->find("node 8"), std::string::npos) << *reason;
  EXPECT_NE(reason->find("2 bonds"), std::string::npos) << *reason;
}

TEST(BondNetwork, AFlatSheetFloats) {
  std::vector<Vector3d> sheet;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      sheet.emplace_back(i, j, 0);
    }
  }
  EXPECT_TRUE(floating_part(network(sheet)));
}

TEST(BondNetwork, TwoPiecesFloat) {
  auto nodes = cube({0, 0, 0});
  const auto other = cube({5, 0, 0});
  nodes.insert(nodes.end(), other.begin(), other.end());
  const auto reason = floating_part(network(nodes));
  ASSERT_TRUE(reason);
  EXPECT_NE(reason->find("2 pieces"), std::string::npos) << *reason;
}

TEST(BondNetwork, NodeVolumesSumTheCubesOfTheirBonds) {
  const auto grain = network(cube({0, 0, 0}));
  for (const double volume : reference_node_volumes(grain.n_nodes(), grain.bonds)) {
    EXPECT_NEAR(volume, 3.0 + 3.0 * 2.0 * std::sqrt(2.0), 1e-12);
  }
}

} // namespace
} // namespace boba
