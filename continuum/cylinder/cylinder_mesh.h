// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/meridian_body.h"

namespace boba::continuum {

/// How finely the quarter meridian of a cylinder is cut.
struct CylinderMeshSize {
  /// Element size at the corner where the held end meets the free side, in units of min(R, h/2).
  double corner = 1e-3;
  /// Growth of the element size with the distance from that corner.
  double growth = 0.35;
  /// Largest element, in units of min(R, h/2), within that distance of end and side.
  double coarsest = 0.2;
};

/// Rectangle 0 <= r <= radius, 0 <= z <= height / 2: z = 0 is mid_plane, z = height / 2 plate_side, r = R lateral.
MeridianMesh cylinder_mesh(double radius, double height, const CylinderMeshSize& size);

/// The same rectangle cut evenly into n x n elements, n = 2^refinements.
MeridianMesh uniform_cylinder_mesh(double radius, double height, unsigned refinements);

} // namespace boba::continuum
