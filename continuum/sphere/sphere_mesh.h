// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/elasticity/meridian_body.h"

namespace boba::continuum {

/// How finely the quarter meridian of a sphere is cut.
struct SphereMeshSize {
  /// Contact radii that the mesh serves: it is fine between them, on the surface.
  double lowest_edge, highest_edge;
  /// Elements across the contact radius, at its edge.
  double elements_across = 48;
  /// Elements across the contact radius elsewhere on the pressed surface.
  double elements_inside = 12;
  /// Growth of the element size with the distance from the contact edge.
  double growth = 0.35;
  /// Largest element, in units of R.
  double coarsest = 0.25;
};

/// Wanted element size at the point (r, z) of a cell whose half diagonal is half_cell.
double wanted_size(double r, double z, double half_cell, double radius, const SphereMeshSize& size);

/// Quarter disk of radius R; the curved boundary is plate_side (all of it: the free surface too).
MeridianMesh sphere_mesh(double radius, const SphereMeshSize& size);

/// The quarter disk cut evenly: global refinements of a coarse mesh of three cells.
MeridianMesh uniform_sphere_mesh(double radius, unsigned refinements);

} // namespace boba::continuum
