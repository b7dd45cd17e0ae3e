// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

namespace boba::calibration {

/// Moduli of a periodic network measured by the dynamic engine: the check of the static solve.
struct DynamicModuli {
  double bulk = 0.0;  ///< from a compression to a small pressure, k/d
  double shear = 0.0; ///< from a simple shear xy and a rest, k/d
};

/// \param pressure of the compression, k/d; \param strain of the shear; \param settle rest after it, tau.
DynamicModuli dynamic_moduli(const GrainTemplate& box, double alpha, double pressure = 2e-3, double strain = 1e-3,
                             double settle = 600.0);

} // namespace boba::calibration
