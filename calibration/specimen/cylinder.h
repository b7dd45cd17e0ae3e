// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "calibration/specimen/bulk_cut.h"

#include <Eigen/Core>
#include <vector>

namespace boba::calibration {

/// A cylinder along z squeezed between held end slabs.
struct CylinderTest {
  double alpha = 0.0;           ///< k d
  double strain = 1e-3;         ///< shortening over the free height between the slabs
  double clamp_thickness = 2.0; ///< d; nodes this close to the lowest and to the highest node are held
};

/// What it says about the solid. Strains are those of the middle third of the free height; stress is the axial force
/// over an area.
///
/// Which area is a choice of 10 to 15 % at R = 10 d. The rule: the area at which the middle third has as much bond
/// stiffness (sum of r0^2) per volume as the bulk. A cut takes away all bonds that cross it, so a layer of about <r^3>
/// / 4 <r^2> = 0.3 d has the nodes of the solid but no stiffness; this rule sees it in the undeformed network, before
/// anything is measured.
struct CylinderResult {
  double axial_strain = 0.0;   ///< slope of u_z over z, negative in compression
  double lateral_strain = 0.0; ///< sum(u.r) / sum(r.r) over the nodes' positions r across the axis
  double force = 0.0;          ///< k d, positive when the ends are pushed apart
  double free_height = 0.0;    ///< d
  double bond_area = 0.0; ///< d^2: sum of r0^2 in the middle third / (that of the bulk's volume), the rule used for E
  double density_area = 0.0;  ///< d^2: nodes in the middle third / (density times its height)
  double centre_radius = 0.0; ///< d: largest distance of a node centre from the axis, in the middle third

  double poisson() const { return -lateral_strain / axial_strain; }
  double young() const { return young_of(bond_area); }
  double young_of(double area) const { return -force / area / axial_strain; }
};

/// Relaxes the squeezed cylinder by the static solver. `bulk` is what the cylinder was cut from.
/// \throws std::invalid_argument when nothing is left between the slabs; std::runtime_error when the solve fails.
CylinderResult static_cylinder(const GrainTemplate& cylinder, const CylinderTest& test, const BulkDensity& bulk);

/// The same by the engine: the ends move at `velocity` each (d/tau), then the cylinder rests for `settle` (tau).
CylinderResult dynamic_cylinder(const GrainTemplate& cylinder, const CylinderTest& test, const BulkDensity& bulk,
                                double velocity = 1e-3, double settle = 400.0);

} // namespace boba::calibration
