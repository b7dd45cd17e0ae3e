// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/fit/foam_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace boba::calibration {

namespace {

/// Slope of the stress and lateral contraction at the smallest strain.
continuum::Material small_strain(const std::vector<UniaxialPoint>& points) {
  const auto nearest = std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::abs(a.axial_stretch - 1.0) < std::abs(b.axial_stretch - 1.0);
  });
  const double strain = nearest->axial_stretch - 1.0;
  return {nearest->stress / strain, std::clamp(-(nearest->lateral_stretch - 1.0) / strain, -0.95, 0.48)};
}

} // namespace

FoamFit fit_foam(const std::vector<UniaxialPoint>& points, int n_terms) {
  if (points.empty()) {
    throw std::invalid_argument("foam fit: a curve without points");
  }
  std::vector<continuum::UniaxialState> states;
  for (const UniaxialPoint& point : points) {
    states.push_back({point.axial_stretch, point.lateral_stretch, point.stress});
  }
  FoamFit fit{.terms = continuum::fitted_foam(states, small_strain(points), n_terms)};
  const continuum::Foam foam(fit.terms);
  double axial = 0.0, lateral = 0.0, largest = 0.0;
  for (const continuum::UniaxialState& state : states) {
    const auto stress = foam.response({state.axial_stretch, state.lateral_stretch, state.lateral_stretch}).first;
    axial += std::pow(stress[0] - state.stress, 2) / static_cast<double>(states.size());
    lateral += std::pow(stress[1], 2) / static_cast<double>(states.size());
    largest = std::max(largest, std::abs(state.stress));
  }
  fit.axial_residual = std::sqrt(axial) / largest;
  fit.lateral_residual = std::sqrt(lateral) / largest;
  return fit;
}

} // namespace boba::calibration
