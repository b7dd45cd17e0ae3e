// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stepper.h"

namespace boba::bench {

/// P at P~ = P (2 - 2 nu^2) / E = 0.1 with the pairs published by Clemmer, Hackney & Grest, k/d.
double dense_pressure(double alpha);

/// Rates of shear of the published study, the fastest and the slowest, 1/tau.
inline constexpr double fastest_rate = 1.024e-3, slowest_rate = 1.6e-5;

/// Shear, and a barostat of gain 0.02 d/(k tau).
CellRates dense_shear_rates(double excess_pressure, double rate = fastest_rate);

/// A packing under shear at P~ = 0.1: grains inserted at random at a packing fraction of 0.38, compressed and sheared
/// to a strain of 0.1. That takes minutes for large packings, so the state is kept in the template cache's folder.
///
/// \param n_nodes per grain; \param alpha 0 or 2, for which the published E and nu give P from P~
Packing dense_packing(int n_grains, int n_nodes, double alpha);

} // namespace boba::bench
