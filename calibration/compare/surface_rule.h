// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "calibration/specimen/bulk_cut.h"

namespace boba::calibration {

/// Where the surface of a round grain of nodes is, and how soft, fixed from its undeformed nodes alone.
///
/// The surface layer is one layer of the bulk: density^(2/3) nodes per area, the outermost ones. A plate touches a node
/// at d/2, so the surface that a continuum's plate meets lies d/2 outside the layer's mean radius. Every node of the
/// layer is one spring of the wall law (bpm/laws/wall.h), so that plate and body have between them p = c1 g + c3 g^3 of
/// the overlap g.
struct SurfaceRule {
  double radius = 0.0;         ///< d: mean radius of the layer plus d/2
  double nodes_per_area = 0.0; ///< n_s, d^-2
  double c1 = 0.0;             ///< 2 k n_s, k/d^2
  double c3 = 0.0;             ///< 8 k3 n_s, k/d^4
  int n_layer = 0;             ///< nodes in the layer
  double body = 0.0;           ///< d: where displacements of the surface are told; 0 for `radius`
};

/// `density` of the bulk, nodes per d^3. \throws std::invalid_argument for a template with a period.
SurfaceRule surface_rule(const GrainTemplate& sphere, double density);

/// Radius (d) of the sphere of bulk that has the grain's bond stiffness, sum of r0^2: where the solid ends.
double bond_radius(const GrainTemplate& sphere, const BulkDensity& bulk);

} // namespace boba::calibration
