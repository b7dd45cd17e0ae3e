// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba::continuum::testing {

/// The exact linear solution of a solid sphere (R = 1, E = 1) pressed by two rigid frictionless plates to the contact
/// radius a, by a series of spheroidal harmonics. It shares nothing with the finite elements.
struct LegendreSphere {
  /// Approach of one plate, force on it, pressure at the pole per reference area.
  double approach, force, central_pressure;
};

struct LegendreOrder {
  /// Harmonics are summed to n = order / a.
  double order = 400;
  /// Terms of the pressure sqrt(1 - s^2) * polynomial in s^2, s = r / a.
  int terms = 5;
};

/// The plate's constraint and the pressure act along z. The pressure is a combination of functions that end like a
/// square root at r = a; they and the approach follow from as many tests of z + u_z = 1 - approach, weighted with the
/// same functions and one more. A weighted sum over harmonics n loses at order N only (N a)^-3, because both load and
/// weight have coefficients of n^-2 and the compliance falls like 1/n; that rest is extrapolated away.
/// Source: A. I. Lur'e, Three-dimensional problems of the theory of elasticity, Interscience 1964, section 6.3 (the
/// solid sphere under axisymmetric tractions).
LegendreSphere legendre_sphere(double poisson, double contact_radius, LegendreOrder order = {});

} // namespace boba::continuum::testing
