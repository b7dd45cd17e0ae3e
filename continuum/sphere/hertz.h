// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/material.h"

namespace boba::continuum {

/// Hertz's contact of a sphere with a rigid frictionless plate; approach is the plate's own travel towards the
/// sphere's centre (half the travel of two plates).
/// Source: K. L. Johnson, Contact Mechanics, Cambridge University Press 1985, eqs. (4.22) to (4.24).
struct Hertz {
  double force, contact_radius, peak_pressure;
};

/// F = (4/3) E/(1-nu^2) sqrt(R) d^(3/2), a = sqrt(R d), p0 = 3 F / (2 pi a^2).
Hertz hertz(double radius, const Material& material, double approach);

/// Approach of one plate by the relation with the far field that carries Tatara's name,
///   d = 3 (1-nu^2) F / (4 E a) - F f / (pi E),  f = 2 (1+nu) R^2 / (a^2+4R^2)^(3/2) + (1-nu^2) / (a^2+4R^2)^(1/2).
/// Source: Y. Tatara, J. Eng. Mater. Technol. 113 (1991) 285.
double tatara_approach(double radius, const Material& material, double force, double contact_radius);

} // namespace boba::continuum
