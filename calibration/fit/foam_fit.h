// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/specimen/uniaxial_curve.h"

#include <vector>

namespace boba::calibration {

/// One term of the compressible foam law
///
///     W = sum_k 2 mu_k / a_k^2 [ l1^a_k + l2^a_k + l3^a_k - 3 + (J^(-a_k b_k) - 1) / b_k ],   b_k = nu_k / (1 - 2
///     nu_k)
///
/// with the same parameters as the continuum's `foam` law. Source: B. Storakers, J. Mech. Phys. Solids 34 (1986) 125.
struct FoamTerm {
  double mu = 0.0;       ///< k/d
  double exponent = 0.0; ///< a
  double poisson = 0.0;  ///< nu
};

/// Nominal stress along one axis under stretches (axial, lateral, lateral): dW/dl (k/d).
double foam_axial_stress(const std::vector<FoamTerm>& terms, double axial, double lateral);
double foam_lateral_stress(const std::vector<FoamTerm>& terms, double axial, double lateral);

struct FoamFit {
  std::vector<FoamTerm> terms;
  double axial_residual = 0.0;   ///< root mean square of the axial stress's misfit over its largest size
  double lateral_residual = 0.0; ///< the same of the lateral stress, which is to vanish
};

/// Least squares (Levenberg-Marquardt, Eigen) of the axial stress and of the vanishing lateral stress at the points'
/// stretches. \param n_terms 1 or 2 \throws std::invalid_argument for fewer points than parameters or another number of
/// terms.
FoamFit fit_foam(const std::vector<UniaxialPoint>& points, int n_terms);

} // namespace boba::calibration
