// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>

namespace boba::continuum {

/// Boundary ids of an octant mesh: the planes x = 0, y = 0, z = 0 (mirrors), the pressed boundary and the free side.
enum OctantBoundary : unsigned { mirror_x = 0, mirror_y = 1, mirror_z = 2, octant_plate_side = 3, octant_lateral = 4 };

/// Which octant: quarter of a cylinder's upper half, or of a sphere's.
struct OctantShape {
  /// height: of the whole cylinder; 0 for a sphere.
  double radius = 1, height = 0;
  /// Elements of size `wanted(x, y, z)` or smaller after the even refinements.
  unsigned refinements = 2;
  std::function<double(double, double, double)> wanted = nullptr;
};

/// The octant of a sphere, fine (elements_across of the contact radius) where a contact of radius lowest_edge to
/// highest_edge may end.
OctantShape graded_sphere(double radius, double lowest_edge, double highest_edge, double elements_across);

} // namespace boba::continuum
