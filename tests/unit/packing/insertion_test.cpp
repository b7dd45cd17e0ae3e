// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/random.h"
#include "bpm/packing/insertion.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace boba {
namespace {

/// Smallest gap between spheres over all images, by brute force.
double smallest_gap(const std::vector<Vector3>& x, const std::vector<double>& radii, double edge) {
  double gap = edge;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) {
      for (int image = 0; image < 27; ++image) {
        if (i != j || image != 13) {
          const Vector3 shift = Eigen::Vector3i(image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1).cast<double>();
          gap = std::min(gap, (x[i] - x[j] + edge * shift).norm() - radii[i] - radii[j]);
        }
      }
    }
  }
  return gap;
}

double edge_for(const std::vector<double>& radii, double fraction) {
  double volume = 0.0;
  for (const double r : radii) {
    volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
  }
  return std::cbrt(volume / fraction);
}

TEST(PlaceSpheres, LeavesNoOverlapForAnyNumberAndMixOfSizes) {
  for (const int n : {1, 2, 3, 8, 64, 300}) {
    for (const double ratio : {1.0, 3.0}) {
      std::vector<double> radii(n, 1.0);
      for (int i = 0; i < n; i += 2) {
        radii[i] = ratio;
      }
      const double edge = std::max(edge_for(radii, 0.5), 2.01 * ratio);
      Random random(7);
      EXPECT_GE(smallest_gap(place_spheres(radii, edge, random), radii, edge), 0.0) << n << " " << ratio;
    }
  }
}

TEST(PlaceSpheres, SameSeedSamePlaces) {
  const std::vector<double> radii(50, 1.0);
  Random a(3), b(3), c(4);
  const double edge = edge_for(radii, 0.5);
  const auto first = place_spheres(radii, edge, a);
  EXPECT_EQ(first, place_spheres(radii, edge, b));
  EXPECT_NE(first, place_spheres(radii, edge, c));
}

TEST(PlaceSpheres, GivesUpAboveRandomClosePacking) {
  Random random(1);
  const std::vector<double> radii(20, 1.0);
  EXPECT_THROW(place_spheres(radii, edge_for(radii, 0.72), random), std::runtime_error);
}

TEST(RandomRotation, HasTheMomentsOfTheUniformDistribution) {
  // For uniform rotations every matrix element has mean 0 and mean square 1/3.
  Random random(11);
  constexpr int n = 40000;
  Matrix3 mean = Matrix3::Zero(), square = Matrix3::Zero();
  for (int i = 0; i < n; ++i) {
    const Eigen::Quaterniond q = random_rotation(random);
    EXPECT_NEAR(q.norm(), 1.0, 1e-14);
    mean += q.toRotationMatrix() / n;
    square += q.toRotationMatrix().cwiseAbs2() / n;
  }
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 5.0 / std::sqrt(3.0 * n));
  EXPECT_LT((square.array() - 1.0 / 3.0).abs().maxCoeff(), 5.0 * std::sqrt(4.0 / 45.0 / n));
}

/// A dumbbell: two nodes 4 d apart.
std::shared_ptr<const GrainTemplate> dumbbell() {
  GrainTemplate grain;
  grain.position = {Vector3(-2, 0, 0), Vector3(2, 0, 0)};
  grain.reference_volume = 20.0;
  return std::make_shared<const GrainTemplate>(grain);
}

TEST(InsertAtRandom, KeepsNodesOfDifferentGrainsADiameterApart) {
  Insertion insertion;
  insertion.templates = {dumbbell()};
  insertion.grains.assign(40, Grain{});
  insertion.packing_fraction = 0.15;
  const Packing packing = insert_at_random(insertion);
  ASSERT_EQ(packing.n_grains(), 40);
  EXPECT_NEAR(packing.box.volume(), 40 * 20.0 / 0.15, 1e-9);
  for (std::size_t i = 0; i < packing.position.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (i / 2 != j / 2) {
        EXPECT_GE(packing.box.minimum_image(packing.position[i] - packing.position[j]).norm(), 1.0);
      }
    }
  }
  for (int g = 0; g < 40; ++g) {
    EXPECT_NEAR((packing.position[2 * g] - packing.position[2 * g + 1]).norm(), 4.0, 1e-12);
  }
}

TEST(InsertAtRandom, NamesTheDensityThatWouldFit) {
  Insertion insertion;
  insertion.templates = {dumbbell()};
  insertion.grains.assign(40, Grain{});
  insertion.packing_fraction = 0.5;
  try {
    insert_at_random(insertion);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("at most 0.183"), std::string::npos) << error.what();
  }
}

} // namespace
} // namespace boba
