// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/bond_order.h"
#include "bpm/measure/neighbours.h"
#include "bpm/measure/spherical_harmonics.h"
#include "tests/support/crystals.h"
#include "tests/support/shapes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <stdexcept>

namespace {

using namespace boba;
using namespace boba::measure;
using crystals::Crystal;

std::vector<double> equal_radii(const Crystal& crystal) {
  return std::vector<double>(crystal.centres.size(), 0.5);
}

NeighbourLists by_solid_angle(const Crystal& crystal) {
  return solid_angle_neighbours(crystal.box, crystal.centres);
}

/// Voronoi neighbours that all count the same: what the textbook values are for.
NeighbourLists by_voronoi(const Crystal& crystal) {
  NeighbourLists lists = voronoi_neighbours(crystal.box, crystal.centres, equal_radii(crystal));
  for (auto& list : lists) {
    for (Neighbour& neighbour : list) {
      neighbour.weight = 1.0;
    }
  }
  return lists;
}

void expect_order(const NeighbourLists& neighbours, int n_neighbours, double q4, double q6, CrystalClass crystal) {
  for (const BondOrder& order : bond_order(neighbours)) {
    EXPECT_EQ(order.n_neighbours, n_neighbours);
    EXPECT_NEAR(order.q4, q4, 5.1e-6);
    EXPECT_NEAR(order.q6, q6, 5.1e-6);
    EXPECT_EQ(order.n_solid_bonds, n_neighbours);
    EXPECT_EQ(order.crystal, crystal);
  }
}

TEST(Order, FccHasItsKnownValues) {
  for (const Crystal& crystal : {crystals::fcc(3), crystals::tilted_fcc(4)}) {
    expect_order(by_solid_angle(crystal), 12, 0.19094, 0.57452, CrystalClass::fcc);
    expect_order(by_voronoi(crystal), 12, 0.19094, 0.57452, CrystalClass::fcc);
    const BondOrder order = bond_order(by_solid_angle(crystal)).front();
    EXPECT_NEAR(order.averaged_q4, 0.19094, 5.1e-6); // all grains alike: the average changes nothing
    EXPECT_NEAR(order.averaged_q6, 0.57452, 5.1e-6);
  }
}

TEST(Order, HcpHasItsKnownValues) {
  expect_order(by_solid_angle(crystals::hcp(3)), 12, 0.09722, 0.48476, CrystalClass::hcp);
  expect_order(by_voronoi(crystals::hcp(3)), 12, 0.09722, 0.48476, CrystalClass::hcp);
}

TEST(Order, BccWithFourteenNeighboursHasItsKnownValues) {
  expect_order(by_solid_angle(crystals::bcc(4)), 14, 0.03637, 0.51069, CrystalClass::bcc);
  expect_order(by_voronoi(crystals::bcc(4)), 14, 0.03637, 0.51069, CrystalClass::bcc);
}

TEST(Order, IcosahedronHasItsKnownValues) {
  NeighbourLists neighbours(13);
  for (const Vector3& x : shapes::moved(crystals::icosahedron(), shapes::some_rotation(), Vector3::Zero())) {
    neighbours[0].push_back({static_cast<int>(neighbours[0].size()) + 1, x, 1.0});
  }
  const BondOrder order = bond_order(neighbours).front();
  EXPECT_NEAR(order.q4, 0.0, 1e-12);
  EXPECT_NEAR(order.q6, 0.66332, 5.1e-6);
}

TEST(Order, ThirdInvariantsHaveTheirKnownValues) {
  // Source: Steinhardt, Nelson, Ronchetti (1983); Mickel et al. (2013), table of perfect structures.
  const BondOrder fcc = bond_order(by_solid_angle(crystals::fcc(3))).front();
  EXPECT_NEAR(fcc.averaged_w4, -0.15932, 5.1e-6);
  EXPECT_NEAR(fcc.averaged_w6, -0.01316, 5.1e-6);
  const BondOrder bcc = bond_order(by_solid_angle(crystals::bcc(4))).front();
  EXPECT_NEAR(bcc.averaged_w4, 0.15932, 5.1e-6);
  EXPECT_NEAR(bcc.averaged_w6, 0.01316, 5.1e-6);
}

TEST(Order, ValuesDoNotChangeWhenTheCrystalIsTurned) {
  NeighbourLists neighbours = by_solid_angle(crystals::hcp(3));
  const BondOrder before = bond_order(neighbours)[5];
  for (auto& list : neighbours) {
    for (Neighbour& neighbour : list) {
      neighbour.vector = shapes::some_rotation() * neighbour.vector;
    }
  }
  const BondOrder after = bond_order(neighbours)[5];
  EXPECT_NEAR(before.q4, after.q4, 1e-12);
  EXPECT_NEAR(before.averaged_q6, after.averaged_q6, 1e-12);
  EXPECT_NEAR(before.averaged_w4, after.averaged_w4, 1e-12);
  EXPECT_NEAR(before.averaged_w6, after.averaged_w6, 1e-12);
}

TEST(Order, ShakenCrystalsKeepTheirClassAndAGasHasNone) {
  const auto share = [](const Crystal& crystal, CrystalClass expected) {
    const auto orders = bond_order(by_solid_angle(crystal));
    return static_cast<double>(count_classes(orders)[static_cast<std::size_t>(expected)]) / orders.size();
  };
  constexpr double sigma = 0.05; // of the neighbour distance, in each direction
  EXPECT_GT(share(crystals::shaken(crystals::fcc(6), sigma, 1), CrystalClass::fcc), 0.95);
  EXPECT_GT(share(crystals::shaken(crystals::hcp(6), sigma, 2), CrystalClass::hcp), 0.95);
  EXPECT_GT(share(crystals::shaken(crystals::bcc(7), sigma, 3), CrystalClass::bcc), 0.95);
  EXPECT_GT(share(crystals::gas(1000, 1.0, 4), CrystalClass::disordered), 0.95);
}

TEST(Order, SphericalHarmonicsAreThoseOfTheTextbooks) {
  // Y_40 along z is sqrt(9 / 4 pi); Y_44 in the plane is 3/16 sqrt(35 / 2 pi) exp(4 i phi).
  EXPECT_NEAR(spherical_harmonics<4>(Vector3(0, 0, 2))[4].real(), std::sqrt(9.0 / (4.0 * std::numbers::pi)), 1e-12);
  const auto y = spherical_harmonics<4>(Vector3(std::cos(0.3), std::sin(0.3), 0.0))[8];
  EXPECT_NEAR(std::abs(y - 3.0 / 16.0 * std::sqrt(35.0 / (2.0 * std::numbers::pi)) * std::polar(1.0, 1.2)), 0.0, 1e-12);
  // (1 1 1; 0 0 0) = 0, (2 2 2; 0 0 0) = -sqrt(2/35), (4 4 4; 0 0 0) = sqrt(18/1001), (6 6 6; 0 0 0) = -20/sqrt(46189).
  EXPECT_NEAR(wigner_3j(1, 0, 0), 0.0, 1e-14);
  EXPECT_NEAR(wigner_3j(2, 0, 0), -std::sqrt(2.0 / 35.0), 1e-14);
  EXPECT_NEAR(wigner_3j(4, 0, 0), std::sqrt(18.0 / 1001.0), 1e-13);
  EXPECT_NEAR(wigner_3j(6, 0, 0), -20.0 / std::sqrt(46189.0), 1e-12);
}

/// Sum over all bonds of the weighted neighbour vectors of every grain, with both directions of each bond matched.
void expect_mutual(const NeighbourLists& lists) {
  for (std::size_t i = 0; i < lists.size(); ++i) {
    for (const Neighbour& n : lists[i]) {
      const auto& back = lists[n.grain];
      EXPECT_TRUE(std::any_of(back.begin(), back.end(), [&](const Neighbour& m) {
        return m.grain == static_cast<int>(i) && (m.vector + n.vector).norm() < 1e-7 &&
               std::abs(m.weight - n.weight) < 1e-6;
      }));
    }
  }
}

TEST(Voronoi, CellsFillATiltedBoxAndFacesAreShared) {
  Crystal crystal = crystals::gas(60, 1.0, 9);
  crystal.box = Box({1.0, 2.0, 3.0}, {4.0, 3.0, 5.0}, {1.9, -1.6, 1.4});
  for (Vector3& x : crystal.centres) {
    x = crystal.box.to_position(x / std::cbrt(60.0) + Vector3(2.0, -1.0, 0.0)); // outside the cell on purpose
  }
  std::vector<double> radii;
  for (std::size_t i = 0; i < crystal.centres.size(); ++i) {
    radii.push_back(0.3 + 0.1 * std::sin(static_cast<double>(i)));
  }
  const auto volumes = voronoi_volumes(crystal.box, crystal.centres, radii);
  EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0), crystal.box.volume(), 1e-9);
  const NeighbourLists lists = voronoi_neighbours(crystal.box, crystal.centres, radii);
  expect_mutual(lists);
  for (const auto& list : lists) {
    // The area vectors of a closed cell add up to nothing.
    Vector3 sum = Vector3::Zero();
    for (const Neighbour& n : list) {
      sum += n.weight * n.vector.normalized();
    }
    EXPECT_NEAR(sum.norm(), 0.0, 1e-4);
  }
}

TEST(Voronoi, RadicalPlaneSplitsUnequalNeighbours) {
  // Two grains on a line in a box that is periodic: planes at (r^2 + R1^2 - R2^2) / (2 r) from the first, r = 2 and 3.
  const Box box(Vector3::Zero(), {5.0, 2.0, 2.0});
  const std::vector<Vector3> centres = {{1.0, 1.0, 1.0}, {3.0, 1.0, 1.0}};
  const std::vector<double> radii = {1.0, 0.5};
  const auto volumes = voronoi_volumes(box, centres, radii);
  const double width = (4.0 + 0.75) / 4.0 + (9.0 + 0.75) / 6.0;
  EXPECT_NEAR(volumes[0], 4.0 * width, 1e-12);
  EXPECT_NEAR(volumes[1], 4.0 * (5.0 - width), 1e-12);
}

TEST(Voronoi, FccCellIsTheRhombicDodecahedron) {
  const Crystal crystal = crystals::fcc(3);
  const double face = 1.0 / (2.0 * std::sqrt(2.0)); // the cell's volume 1/sqrt(2) is 12 pyramids of height 1/2
  const NeighbourLists lists = voronoi_neighbours(crystal.box, crystal.centres, equal_radii(crystal));
  for (const auto& list : lists) {
    for (const Neighbour& neighbour : list) {
      EXPECT_NEAR(neighbour.weight, face, 1e-9);
      EXPECT_NEAR(neighbour.vector.norm(), 1.0, 1e-9);
    }
  }
}

TEST(Neighbours, OneGrainIsSurroundedByItsImages) {
  const std::vector<Vector3> centre = {{7.0, -3.0, 0.2}};
  const Box cube(Vector3::Zero(), Vector3::Constant(2.0));
  const auto lists = solid_angle_neighbours(cube, centre);
  ASSERT_EQ(lists.size(), 1u);
  EXPECT_GE(lists[0].size(), 6u);
  for (int k = 0; k < 6; ++k) {
    EXPECT_EQ(lists[0][k].grain, 0);
    EXPECT_NEAR(lists[0][k].vector.norm(), 2.0, 1e-12);
  }
  const auto cells = voronoi_neighbours(cube, centre, std::vector{0.5});
  EXPECT_EQ(cells[0].size(), 6u);
}

TEST(Neighbours, BadInputIsNamed) {
  const Box box(Vector3::Zero(), Vector3::Constant(3.0));
  const std::vector<Vector3> same = {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}}; // the first and third are images
  EXPECT_THROW(solid_angle_neighbours(box, same), std::invalid_argument);
  EXPECT_THROW(voronoi_neighbours(box, same, std::vector{1.0, 1.0, 1.0}), std::invalid_argument);
  EXPECT_THROW(voronoi_neighbours(box, same, std::vector{1.0}), std::invalid_argument);
  const Box open(Vector3::Zero(), Vector3::Constant(3.0), Vector3::Zero(), {false, false, false});
  EXPECT_THROW(solid_angle_neighbours(open, std::vector<Vector3>{{1, 1, 1}, {2, 1, 1}}), std::invalid_argument);
  EXPECT_THROW(voronoi_neighbours(open, std::vector<Vector3>{{1, 1, 1}}, std::vector{1.0}), std::invalid_argument);
  EXPECT_THROW(bond_order({{{5, Vector3::UnitX(), 1.0}}}), std::invalid_argument);
  EXPECT_THROW(bond_order({{}}, {.solid_bond_cosine = 2.0}), std::invalid_argument);
}

} // namespace
