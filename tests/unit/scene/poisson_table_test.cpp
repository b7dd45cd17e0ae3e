// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/input_error.h"
#include "bpm/scene/poisson_table.h"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

namespace boba {
namespace {

const std::vector<double> alphas{-0.8, 0.0, 2.0, 5.0, 12.0};
const std::vector<double> poissons{0.40, 0.25, -0.01, -0.25, -0.52};

TEST(MonotoneCurve, AgreesWithScipy) {
  const MonotoneCurve curve(alphas, poissons, "nu");
  // scipy.interpolate.PchipInterpolator (scipy 1.10.1) on the same points.
  EXPECT_NEAR(curve(-0.7), 0.37966538864030025, 1e-14);
  EXPECT_NEAR(curve(-0.3), 0.3015934497175025, 1e-14);
  EXPECT_NEAR(curve(1.0), 0.10575597854428964, 1e-14);
  EXPECT_NEAR(curve(3.5), -0.14727015789330652, 1e-14);
  EXPECT_NEAR(curve(9.0), -0.44446365755352574, 1e-14);
  EXPECT_NEAR(curve(11.5), -0.5137481115264737, 1e-14);
}

TEST(MonotoneCurve, GoesThroughItsPointsAndFallsBetweenThem) {
  const MonotoneCurve curve(alphas, poissons, "nu");
  for (std::size_t i = 0; i < alphas.size(); ++i) {
    EXPECT_DOUBLE_EQ(curve(alphas[i]), poissons[i]);
    EXPECT_NEAR(curve.inverse(poissons[i]), alphas[i], 1e-12);
  }
  double last = 1.0;
  for (int i = 0; i <= 1280; ++i) {
    const double value = curve(-0.8 + 0.01 * i);
    EXPECT_LT(value, last);
    last = value;
  }
}

TEST(MonotoneCurve, InverseUndoesTheCurve) {
  const MonotoneCurve curve(alphas, poissons, "nu");
  for (int k = 0; k < 35; ++k) {
    const double alpha = -0.79 + 0.37 * k;
    EXPECT_NEAR(curve.inverse(curve(alpha)), alpha, 1e-11);
  }
}

TEST(MonotoneCurve, RefusesWhatIsOutsideOrOutOfOrder) {
  const MonotoneCurve curve(alphas, poissons, "nu");
  EXPECT_THROW(curve(12.01), std::out_of_range);
  EXPECT_THROW(curve(std::nan("")), std::out_of_range);
  EXPECT_THROW(curve.inverse(0.41), std::out_of_range);
  EXPECT_THROW(MonotoneCurve({0, 1, 1}, {0, 1, 2}, "x"), std::invalid_argument);
  EXPECT_THROW(MonotoneCurve({0, 1, 2}, {0, 1, 0.5}, "x"), std::invalid_argument);
  EXPECT_THROW(MonotoneCurve({0}, {0}, "x"), std::invalid_argument);
}

TEST(PoissonTable, InstalledTableHoldsThePublishedPairsWithinTheirRounding) {
  const PoissonTable table = PoissonTable::installed();
  const std::vector<double> youngs{0.58, 1.84, 4.05, 6.04, 8.30};
  for (std::size_t i = 0; i < alphas.size(); ++i) {
    EXPECT_NEAR(table.poisson(alphas[i], 1.0), poissons[i], 0.01);
    EXPECT_NEAR(table.young(alphas[i], 1.0), youngs[i], 0.02 * youngs[i]);
  }
}

TEST(PoissonTable, ScalesWithTheStiffness) {
  const PoissonTable table = PoissonTable::installed();
  EXPECT_DOUBLE_EQ(table.young(6.0, 3.0), 3.0 * table.young(2.0, 1.0));
  EXPECT_DOUBLE_EQ(table.poisson(6.0, 3.0), table.poisson(2.0, 1.0));
  EXPECT_DOUBLE_EQ(table.alpha_of_poisson(-0.1, 3.0), 3.0 * table.alpha_of_poisson(-0.1, 1.0));
}

TEST(PoissonTable, NamesTheReachableInterval) {
  const PoissonTable table = PoissonTable::installed();
  try {
    table.alpha_of_poisson(0.49, 1.0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("not extrapolated"), std::string::npos);
  }
  EXPECT_FALSE(table.effective_modulus(1e6, 1.0));
}

TEST(PoissonTable, RefusesDamagedFiles) {
  const std::string file = testing::TempDir() + "/poisson_table.toml";
  for (const char* text :
       {"", "entry = 3", "[[entry]]\nalpha = 1\n", "[[entry]]\nalpha = 1.0\nyoung = nan\npoisson = 0.1\n",
        "[[entry]]\nalpha=0\nyoung=1\npoisson=0.2\n[[entry]]\nalpha=0\nyoung=2\npoisson=0.1\n", "[["}) {
    std::ofstream(file) << text;
    EXPECT_THROW(PoissonTable{file}, InputError) << text;
  }
  EXPECT_THROW(PoissonTable{testing::TempDir() + "/missing.toml"}, InputError);
}

} // namespace
} // namespace boba
