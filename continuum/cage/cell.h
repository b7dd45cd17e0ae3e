// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/cage/plane.h"

namespace boba::continuum {

/// The convex polyhedron that planes enclose.
struct Cell {
  double volume = 0;
  /// Area of the face on each plane, in the order of the planes.
  std::vector<double> face_areas;
  double area() const;
};

/// The cell of the planes: each face is its plane clipped by all others, V = sum of area times distance over 3.
/// Throws std::invalid_argument for a cage that is open, or a plane that bounds nothing because others lie before it.
Cell cell_of(const std::vector<Plane>& planes);

} // namespace boba::continuum
