// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/lattice_insertion.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <stdexcept>

namespace boba {
namespace {

/// Two nodes 2 d apart: turned at random, and each within 1.5 d of the centre.
Insertion of_dumbbells(int count, double packing_fraction) {
  GrainTemplate grain;
  grain.position = {Vector3(-1, 0, 0), Vector3(1, 0, 0)};
  grain.reference_volume = 14.0;
  Insertion insertion;
  insertion.templates = {std::make_shared<const GrainTemplate>(grain)};
  insertion.grains.assign(static_cast<std::size_t>(count), Grain{});
  insertion.packing_fraction = packing_fraction;
  return insertion;
}

std::vector<Vector3> centres_of(const Packing& packing) {
  std::vector<Vector3> centres;
  for (int g = 0; g < packing.n_grains(); ++g) {
    centres.push_back(0.5 * (packing.position[2 * g] + packing.position[2 * g + 1]));
  }
  return centres;
}

/// Vectors to all centres nearer than `reach`, periodic copies included, by brute force.
std::vector<Vector3> vectors_within(const Packing& packing, const std::vector<Vector3>& centres, int grain,
                                    double reach) {
  std::vector<Vector3> vectors;
  for (const Vector3& other : centres) {
    for (int k = 0; k < 125; ++k) {
      const Vector3 image = packing.box.h() * Vector3(k % 5 - 2, k / 5 % 5 - 2, k / 25 - 2);
      const Vector3 v = other + image - centres[static_cast<std::size_t>(grain)];
      if (v.norm() > 1e-9 && v.norm() < reach) {
        vectors.push_back(v);
      }
    }
  }
  return vectors;
}

struct Expected {
  Arrangement arrangement;
  int count;
  double density; ///< sites times the cube of the neighbour distance, over the volume
  int neighbours, opposite;
};

class OnLattice : public testing::TestWithParam<Expected> {};

TEST_P(OnLattice, EveryGrainHasTheNeighboursOfTheLattice) {
  const Expected& e = GetParam();
  const Packing packing = insert_on_lattice(of_dumbbells(e.count, 0.2), e.arrangement);
  ASSERT_EQ(packing.n_grains(), e.count);
  EXPECT_NEAR(packing.box.volume(), e.count * 14.0 / 0.2, 1e-9 * e.count);
  const double distance = std::cbrt(e.density * 14.0 / 0.2);
  const std::vector<Vector3> centres = centres_of(packing);
  for (int g = 0; g < e.count; ++g) {
    const auto vectors = vectors_within(packing, centres, g, 1.1 * distance);
    EXPECT_EQ(static_cast<int>(vectors.size()), e.neighbours);
    int opposite = 0;
    for (const Vector3& v : vectors) {
      EXPECT_NEAR(v.norm(), distance, 1e-9);
      opposite += static_cast<int>(
          std::count_if(vectors.begin(), vectors.end(), [&](const Vector3& w) { return (v + w).norm() < 1e-9; }));
    }
    EXPECT_EQ(opposite, e.opposite);
  }
}

// hcp differs from fcc in its opposite neighbours: the six of the layer alone.
INSTANTIATE_TEST_SUITE_P(Lattices, OnLattice,
                         testing::Values(Expected{Arrangement::fcc, 32, std::sqrt(2.0), 12, 12},
                                         Expected{Arrangement::hcp, 64, std::sqrt(2.0), 12, 6},
                                         Expected{Arrangement::hcp, 48, std::sqrt(2.0), 12, 6},
                                         Expected{Arrangement::bcc, 54, std::sqrt(27.0) / 4.0, 8, 8},
                                         Expected{Arrangement::sc, 27, 1.0, 6, 6}));

TEST(InsertOnLattice, CountsThatDoNotFillAreToldTheNext) {
  const auto message = [](Arrangement arrangement, int count) {
    try {
      check_lattice_count(arrangement, count);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(Arrangement::fcc, 100),
            "100 grains do not fill a fcc lattice; the next counts that do are 32 and 108");
  EXPECT_EQ(message(Arrangement::fcc, 3), "3 grains do not fill a fcc lattice; the next counts that do are 4");
  EXPECT_EQ(message(Arrangement::bcc, 64),
            "64 grains do not fill a bcc lattice; the next counts that do are 54 and 128");
  EXPECT_EQ(message(Arrangement::sc, 65), "65 grains do not fill a sc lattice; the next counts that do are 64 and 125");
  EXPECT_EQ(message(Arrangement::hcp, 50),
            "50 grains do not fill a hcp lattice; the next counts that do are 48 and 64");
  for (const auto& [arrangement, count] : {std::pair(Arrangement::fcc, 256), std::pair(Arrangement::bcc, 250),
                                           std::pair(Arrangement::sc, 64), std::pair(Arrangement::random, 77)}) {
    EXPECT_EQ(message(arrangement, count), "");
  }
  EXPECT_THROW(insert_on_lattice(of_dumbbells(100, 0.2), Arrangement::fcc), std::invalid_argument);
}

TEST(InsertOnLattice, CellOfHcpIsNearlyCubic) {
  for (const int count : {48, 64, 180, 288, 448}) {
    const Vector3 edges = insert_on_lattice(of_dumbbells(count, 0.2), Arrangement::hcp).box.lengths();
    EXPECT_LE(edges.maxCoeff() / edges.minCoeff(), 1.3) << count;
  }
}

TEST(InsertOnLattice, GrainsAreTurnedAtRandomUnlessToldNotTo) {
  Insertion insertion = of_dumbbells(32, 0.2);
  const auto directions = [&] {
    const Packing packing = insert_on_lattice(insertion, Arrangement::fcc);
    std::vector<Vector3> found;
    for (int g = 0; g < 32; ++g) {
      found.push_back((packing.position[2 * g + 1] - packing.position[2 * g]).normalized());
    }
    return found;
  };
  const auto turned = directions();
  EXPECT_GT((turned[0] - turned[1]).norm(), 1e-3);
  EXPECT_EQ(turned, directions());
  insertion.seed = 2;
  EXPECT_NE(turned, directions());
  insertion.rotate = false;
  for (const Vector3& direction : directions()) {
    EXPECT_NEAR((direction - Vector3::UnitX()).norm(), 0.0, 1e-12);
  }
}

TEST(InsertOnLattice, SpeciesAreDealtOutAtRandomAndAllOfThemPlaced) {
  Insertion insertion = of_dumbbells(108, 0.2);
  for (int g = 0; g < 108; ++g) {
    insertion.grains[static_cast<std::size_t>(g)].species = g < 54 ? 0 : 1;
  }
  const Packing packing = insert_on_lattice(insertion, Arrangement::fcc);
  int ones = 0, ones_in_first_half = 0;
  for (int g = 0; g < 108; ++g) {
    ones += packing.grains[static_cast<std::size_t>(g)].species;
    ones_in_first_half += g < 54 ? packing.grains[static_cast<std::size_t>(g)].species : 0;
  }
  EXPECT_EQ(ones, 54);
  EXPECT_NEAR(ones_in_first_half, 27.0, 4.0 * std::sqrt(54.0 / 4.0 * 54.0 / 107.0)); // hypergeometric
}

TEST(InsertOnLattice, NamesTheDensityThatWouldFit) {
  // Neighbours in fcc may come as near as 3 d: 14 sqrt(2) / 27 of the space.
  try {
    insert_on_lattice(of_dumbbells(32, 0.74), Arrangement::fcc);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("at most 0.733"), std::string::npos) << error.what();
  }
}

TEST(InsertOnLattice, NamesAreKnown) {
  EXPECT_EQ(arrangement_named("hcp"), Arrangement::hcp);
  EXPECT_EQ(arrangement_named("random"), Arrangement::random);
  EXPECT_THROW(arrangement_named("fc"), std::invalid_argument);
}

} // namespace
} // namespace boba
