// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/fit/foam_fit.h"

#include <cmath>
#include <gtest/gtest.h>

namespace boba::calibration {
namespace {

/// Nominal stress of one term along the axis, written out: 2 mu / (a l) (l^a - J^(-a b)), b = nu / (1 - 2 nu).
double axial_stress(const continuum::FoamTerm& term, double axial, double lateral) {
  const double b = term.poisson / (1.0 - 2.0 * term.poisson), a = term.exponent;
  return 2.0 * term.shear / (a * axial) * (std::pow(axial, a) - std::pow(axial * lateral * lateral, -a * b));
}

TEST(Foam, FitRecoversACurveOfOneTerm) {
  // One term keeps lateral = axial^-nu, so the curve has a closed form.
  const continuum::FoamTerm term{.shear = 2.0, .exponent = 3.0, .poisson = 0.2};
  std::vector<UniaxialPoint> points;
  for (const double axial : {0.8, 0.85, 0.9, 0.95, 0.999}) {
    const double lateral = std::pow(axial, -term.poisson);
    points.push_back({axial, lateral, axial_stress(term, axial, lateral), 0.0, 0});
  }
  const FoamFit fit = fit_foam(points, 1);
  EXPECT_NEAR(fit.terms[0].shear, term.shear, 1e-4);
  EXPECT_NEAR(fit.terms[0].exponent, term.exponent, 1e-3);
  EXPECT_NEAR(fit.terms[0].poisson, term.poisson, 1e-4);
  EXPECT_LT(fit.axial_residual, 1e-6);
  EXPECT_THROW(fit_foam(points, 3), std::invalid_argument);
  EXPECT_THROW(fit_foam({points[0]}, 1), std::invalid_argument);
  EXPECT_THROW(fit_foam({}, 1), std::invalid_argument);
}

} // namespace
} // namespace boba::calibration
