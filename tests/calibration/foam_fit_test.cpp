// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/fit/foam_fit.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

/// W of one term, written out, for the difference quotient.
double energy(const FoamTerm& term, double l1, double l2, double l3) {
  const double b = term.poisson / (1.0 - 2.0 * term.poisson), a = term.exponent;
  return 2.0 * term.mu / (a * a) *
         (std::pow(l1, a) + std::pow(l2, a) + std::pow(l3, a) - 3.0 + (std::pow(l1 * l2 * l3, -a * b) - 1.0) / b);
}

TEST(Foam, StressIsTheDerivativeOfTheEnergy) {
  const FoamTerm term{.mu = 1.7, .exponent = -3.0, .poisson = -0.3};
  const double h = 1e-6;
  EXPECT_NEAR(foam_axial_stress({term}, 0.9, 0.95),
              (energy(term, 0.9 + h, 0.95, 0.95) - energy(term, 0.9 - h, 0.95, 0.95)) / (2.0 * h), 1e-8);
  EXPECT_NEAR(foam_lateral_stress({term}, 0.9, 0.95),
              (energy(term, 0.9, 0.95 + h, 0.95) - energy(term, 0.9, 0.95 - h, 0.95)) / (2.0 * h), 1e-8);
}

TEST(Foam, FitRecoversACurveOfOneTerm) {
  // One term keeps lateral = axial^-nu, so the curve has a closed form.
  const FoamTerm term{.mu = 2.0, .exponent = 3.0, .poisson = 0.2};
  std::vector<UniaxialPoint> points;
  for (const double axial : {0.8, 0.85, 0.9, 0.95, 0.999}) {
    const double lateral = std::pow(axial, -term.poisson);
    points.push_back({axial, lateral, foam_axial_stress({term}, axial, lateral), 0.0, 0});
  }
  const FoamFit fit = fit_foam(points, 1);
  EXPECT_NEAR(fit.terms[0].mu, term.mu, 1e-4);
  EXPECT_NEAR(fit.terms[0].exponent, term.exponent, 1e-3);
  EXPECT_NEAR(fit.terms[0].poisson, term.poisson, 1e-4);
  EXPECT_LT(fit.axial_residual, 1e-6);
  EXPECT_THROW(fit_foam(points, 3), std::invalid_argument);
  EXPECT_THROW(fit_foam({points[0]}, 1), std::invalid_argument);
}

} // namespace
} // namespace boba::calibration
