// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/specimen/uniaxial_curve.h"
#include "continuum/elasticity/hyperelastic.h"

#include <vector>

namespace boba::calibration {

/// The continuum's foam law (continuum/elasticity/hyperelastic.h) nearest to a network's curve; moduli in k/d.
struct FoamFit {
  std::vector<continuum::FoamTerm> terms;
  double axial_residual = 0.0;   ///< root mean square of the axial stress's misfit over its largest size
  double lateral_residual = 0.0; ///< the same of the lateral stress, which is to vanish
};

/// As continuum::fitted_foam, with the moduli of the point nearest to rest as the first guess. \param n_terms 1 or 2
/// \throws std::invalid_argument for no points, fewer than parameters or another number of terms.
FoamFit fit_foam(const std::vector<UniaxialPoint>& points, int n_terms);

} // namespace boba::calibration
