// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/elasticity/gradient_law.h"

namespace boba::continuum {

LinearLaw::LinearLaw(double shear, double lame) : tangent_(GradientTangent::Zero()) {
  const int normal[] = {0, 3, 4};
  for (const int i : normal) {
    for (const int j : normal) {
      tangent_(i, j) = lame;
    }
    tangent_(i, i) += 2 * shear;
  }
  tangent_.block<2, 2>(1, 1).setConstant(shear);
}

GradientResponse LinearLaw::at(const Gradient& gradient) const {
  return {tangent_ * gradient, tangent_};
}

} // namespace boba::continuum
