// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace boba::continuum {

struct HullMeasures {
  double volume = 0, surface = 0;
};

/// Volume and surface of the convex hull of points of one octant and their images in x = 0, y = 0 and z = 0: the
/// measures' own definition of a grain's volume and area.
HullMeasures hull_of_mirrored(const std::vector<Eigen::Vector3d>& points);

} // namespace boba::continuum
