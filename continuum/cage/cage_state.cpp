// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/cage/cage_state.h"

#include "continuum/cage/plane.h"

#include <cmath>
#include <numbers>

namespace boba::continuum {

double CageState::pressure_on_faces(double cell_volume) const {
  double sum = 0;
  for (const PatchState& patch : patches) {
    // As many planes are images of this one as its normal has octants: 8 over those that share a patch.
    sum += 8.0 / octants_of({patch.normal, patch.distance}) * patch.force * patch.distance;
  }
  return sum / (3 * cell_volume);
}

double CageState::asphericity() const {
  return std::pow(hull_surface, 1.5) / (6 * std::sqrt(std::numbers::pi) * hull_volume);
}

} // namespace boba::continuum
