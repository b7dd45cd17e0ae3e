// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/convex_hull.h"

namespace boba::measure {

/// Size and shape of a grain, taken from its convex hull as a uniform solid.
struct HullShape {
  double volume = 0.0;                ///< V, d^3
  double area = 0.0;                  ///< A, d^2
  double asphericity = 0.0;           ///< A^(3/2) / (6 sqrt(pi) V); 1 for a sphere
  Vector3 centroid = Vector3::Zero(); ///< d
  Vector3 moments = Vector3::Zero();  ///< principal moments of inertia for unit mass, ascending, d^2
  Matrix3 axes = Matrix3::Identity(); ///< columns: the principal axes belonging to `moments`, right-handed
};

/// Volume, area, asphericity and inertia of a hull, summed over the tetrahedra from one inner point to the triangles.
///
/// V = sum a . (b x c) / 6, A = sum |(b - a) x (c - a)| / 2, second moments V_t/20 (sum v v^T + (sum v)(sum v)^T).
/// \throws std::invalid_argument for a mesh without volume.
/// Source: docs/notation.md, "asphericity" (Boromand et al. 2019).
HullShape hull_shape(const ConvexHull& hull);

} // namespace boba::measure
