// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace boba::continuum {

/// A pressed node of a contact: distance from the axis, pressure, and the weight of its square in a fit.
struct ProfilePoint {
  double r, pressure, weight = 1;
};

/// Radius at which the contact ends, from pressed points sorted by r: the square of the pressure, which goes to zero
/// linearly, is extrapolated by a parabola in r^2 from the points beyond `innermost` times the last one's r. Those
/// within `margin` of the last carry the error of the broken element and are left out. Returns the last point's r when
/// the fit does not end within two margins of it, and 0 without points.
double extrapolated_edge(const std::vector<ProfilePoint>& points, double margin, double innermost);

/// Pressure on the axis, from an even polynomial through the points of the inner half.
double pressure_on_axis(const std::vector<ProfilePoint>& points, double edge);

} // namespace boba::continuum
