// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace boba::continuum {

/// A rigid frictionless plane that keeps the material in normal . x <= distance; unit normal, distance > 0 (length).
struct Plane {
  Eigen::Vector3d normal;
  double distance;
};

/// The planes at `factor` times their distances: the cage closes towards the origin.
std::vector<Plane> scaled(std::vector<Plane> planes, double factor);

/// The planes whose normals have no negative component: by mirror symmetry the only ones that one octant meets first.
std::vector<Plane> octant_planes(const std::vector<Plane>& planes);

/// The planes of an octant and their images in x = 0, y = 0 and z = 0: the whole cage.
std::vector<Plane> mirror_images(const std::vector<Plane>& planes);

/// Octants that share a contact patch of a plane: 2 for every component of the normal that is zero.
int octants_of(const Plane& plane);

} // namespace boba::continuum
