// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/elastic_constants.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

TEST(ElasticConstants, FollowTheClosedForms) {
  const ElasticConstants steel_like{.bulk = 5.0 / 3.0, .shear = 1.0}; // lambda = mu = 1
  EXPECT_NEAR(steel_like.poisson(), 0.25, 1e-15);
  EXPECT_NEAR(steel_like.young(), 2.5, 1e-15);
}

TEST(ElasticConstants, AnIsotropicTensorIsItsOwnIsotropicPart) {
  const ElasticConstants constants{.bulk = 1.3, .shear = 2.1};
  const Stiffness c = isotropic_stiffness(constants);
  EXPECT_NEAR(c(0, 0), 1.3 + 4.0 / 3.0 * 2.1, 1e-14);
  EXPECT_NEAR(c(0, 1), 1.3 - 2.0 / 3.0 * 2.1, 1e-14);
  EXPECT_NEAR(c(3, 3), 2.1, 1e-14);
  const ElasticConstants back = isotropic_part(c);
  EXPECT_NEAR(back.bulk, 1.3, 1e-14);
  EXPECT_NEAR(back.shear, 2.1, 1e-14);
  EXPECT_LT(anisotropy(c), 1e-15);
  EXPECT_EQ(asymmetry(c), 0.0);
}

TEST(ElasticConstants, ACubicCrystalIsMeasuredByItsZenerRatio) {
  // C11 = 2, C12 = 1, C44 = 1: G = (2 (C11 - C12)/2 + 3 C44) / 5; the norms are written out over all 81 entries.
  Stiffness c = Stiffness::Zero();
  c.topLeftCorner<3, 3>().setConstant(1.0);
  c.topLeftCorner<3, 3>().diagonal().setConstant(2.0);
  c.bottomRightCorner<3, 3>().diagonal().setConstant(1.0);
  const double g = (2.0 * 0.5 + 3.0 * 1.0) / 5.0;
  const ElasticConstants iso = isotropic_part(c);
  EXPECT_NEAR(iso.shear, g, 1e-14);
  EXPECT_NEAR(iso.bulk, 4.0 / 3.0, 1e-14);
  double difference = 0.0, whole = 0.0;
  const auto cubic = [](int i, int j, int k, int l, double c11, double c12, double c44) {
    if (i == j && k == l) {
      return i == k ? c11 : c12;
    }
    return (i == k && j == l) || (i == l && j == k) ? c44 : 0.0;
  };
  const double l11 = iso.bulk + 4.0 / 3.0 * g, l12 = iso.bulk - 2.0 / 3.0 * g;
  for (int n = 0; n < 81; ++n) {
    const int i = n % 3, j = n / 3 % 3, k = n / 9 % 3, l = n / 27;
    const double value = cubic(i, j, k, l, 2, 1, 1);
    whole += value * value;
    difference += std::pow(value - cubic(i, j, k, l, l11, l12, g), 2);
  }
  EXPECT_NEAR(anisotropy(c), std::sqrt(difference / whole), 1e-14);
}

TEST(Estimate, IsTheMeanAndItsStandardError) {
  const Estimate value = estimate({1.0, 2.0, 3.0, 4.0});
  EXPECT_DOUBLE_EQ(value.mean, 2.5);
  EXPECT_NEAR(value.error, std::sqrt(5.0 / 3.0 / 4.0), 1e-15);
  EXPECT_TRUE(std::isnan(estimate({1.0}).error));
}

} // namespace
} // namespace boba::calibration
