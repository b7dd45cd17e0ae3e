// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace boba::continuum {

/// What one plane and the material exert on each other; numbers of the whole face.
struct PatchState {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double distance = 0;
  double force = 0;
  /// Reference area of the nodes that the plane holds, and the largest nodal force over nodal area.
  double area = 0, peak_pressure = 0;
};

/// A sphere pressed in a cage, in equilibrium; numbers of the whole sphere.
struct CageState {
  /// Distance of the nearest plane over the radius.
  double closing = 1;
  /// Deformed volume, surface, and the part of the surface that lies on planes.
  double volume = 0, surface = 0, facets = 0;
  /// Volume and surface of the convex hull of the deformed surface's nodes.
  double hull_volume = 0, hull_surface = 0;
  /// Elastic energy: of the sphere, and with what compliant planes store.
  double body_energy = 0, energy = 0;
  /// Integral of P : F over the reference volume (linear: sigma : (1 + grad u)), the trace of the virial.
  double virial = 0;
  /// Mean of -tr(sigma) / 3 over the body, its extremes, and the largest Mises stress, at integration points.
  double mean_pressure = 0, lowest_pressure = 0, highest_pressure = 0, largest_mises = 0;
  /// Planes of one octant.
  std::vector<PatchState> patches;
  int active_set_iterations = 0, cg_iterations = 0, newton_iterations = 0;
  long n_unknowns = 0;
  double seconds = 0;

  /// Pressure on the cage by the forces on its faces, sum over all faces of F h / (3 V_c).
  double pressure_on_faces(double cell_volume) const;
  /// The same by the virial, -virial / (3 V_c).
  double pressure_by_virial(double cell_volume) const { return -virial / (3 * cell_volume); }
  /// A^(3/2) / (6 sqrt(pi) V) of the hull: 1 for a sphere.
  double asphericity() const;
};

} // namespace boba::continuum
