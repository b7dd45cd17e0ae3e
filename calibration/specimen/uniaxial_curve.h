// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

#include <vector>

namespace boba::calibration {

/// One state of a periodic network stretched along one axis, free of stress across it.
struct UniaxialPoint {
  double axial_stretch = 1.0;   ///< length over undeformed length; below 1 in compression
  double lateral_stretch = 1.0; ///< mean of the two directions across
  double stress = 0.0;          ///< nominal: force over undeformed area, tension positive, k/d
  double lateral_stress = 0.0;  ///< left over, nominal, k/d
  int n_contacts = 0;           ///< unbonded pairs closer than d
};

/// The states at the given engineering strains (positive in tension), each reached from the previous one on its side of
/// zero. The axis is x; the cell stays a cuboid with equal stretches across, at which the mean lateral stress vanishes
/// to 1e-6 k/d. \throws std::runtime_error when a state cannot be relaxed.
std::vector<UniaxialPoint> uniaxial_curve(const GrainTemplate& box, double alpha, const std::vector<double>& strains);

} // namespace boba::calibration
