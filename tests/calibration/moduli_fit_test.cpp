// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/fit/moduli_fit.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

/// Moduli that are not of the fit's own form.
ElasticConstants model(double alpha) {
  return {.bulk = 1.371 - 0.137 / std::pow(1.12 + alpha, 0.83), .shear = 0.6535 * (alpha + 1.1) + 0.03};
}

ModuliFit fit_to_model() {
  const std::vector<double> alphas = {-0.95, -0.85, -0.7, -0.4, 0.0, 0.6, 1.5, 3.0, 5.5, 9.0, 14.0, 22.0, 40.0};
  std::vector<ElasticConstants> constants;
  for (const double alpha : alphas) {
    constants.push_back(model(alpha));
  }
  return {alphas, constants};
}

TEST(ModuliFit, FollowsSmoothModuliBetweenItsPoints) {
  const ModuliFit fit = fit_to_model();
  for (const double alpha : {-0.9, -0.5, 0.3, 2.0, 7.0, 30.0}) {
    EXPECT_NEAR(fit.at(alpha).bulk / model(alpha).bulk, 1.0, 3e-3) << alpha;
    EXPECT_NEAR(fit.at(alpha).shear / model(alpha).shear, 1.0, 3e-3) << alpha;
  }
  EXPECT_LT(fit.bulk_residual(), 2e-3);
  EXPECT_LT(fit.shear_residual(), 2e-3);
}

TEST(ModuliFit, FindsTheAlphaOfAPoissonRatio) {
  const ModuliFit fit = fit_to_model();
  for (const double alpha : {-0.8, 0.0, 2.0, 12.0}) {
    EXPECT_NEAR(fit.alpha_of_poisson(fit.at(alpha).poisson()), alpha, 1e-8);
    EXPECT_NEAR(fit.at(fit.alpha_of_poisson(model(alpha).poisson())).poisson(), model(alpha).poisson(), 1e-10);
  }
}

TEST(ModuliFit, NamesTheReachableInterval) {
  const ModuliFit fit = fit_to_model();
  for (const double poisson : {0.499, -0.99}) {
    try {
      fit.alpha_of_poisson(poisson);
      ADD_FAILURE() << "accepted " << poisson;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("allowed are"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(ModuliFit({0.0, 1.0}, {model(0), model(1)}), std::invalid_argument);
}

} // namespace
} // namespace boba::calibration
