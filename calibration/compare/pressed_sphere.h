// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "calibration/compare/surface_rule.h"

#include <Eigen/Core>
#include <array>
#include <vector>

namespace boba::calibration {

/// What presses a grain of nodes along z.
enum class Press {
  walls,  ///< two rigid walls
  mirror, ///< its own mirror image, each against a wall on the other side
  twin,   ///< a copy of itself turned about z by one radian, each against a wall on the other side
  images, ///< its own periodic images, shifted copies
};

/// A surface point's displacement, averaged around the axis and over both halves; of the undeformed position.
struct SurfacePoint {
  double angle = 0.0;  ///< from the equator, rad
  double radial = 0.0; ///< u_r, d, outward from the axis
  double axial = 0.0;  ///< u_z, d, on the upper half (negative: towards the equator)
  int n_nodes = 0;
};

/// A sphere of nodes at rest under a press.
struct SphereState {
  double approach = 0.0;       ///< d, of one contact: the rule's radius minus half the distance of the planes
  double force = 0.0;          ///< k d
  double contact_radius = 0.0; ///< d: sqrt(5/2 <r^2>) over the nodes in contact, weighted by their force; Hertz's a
  double bulge = 0.0;          ///< d: u_r at the equator of the rule's radius
  int n_touching = 0;          ///< nodes in contact with the upper wall
  double imbalance = 0.0;      ///< difference of the forces of the two walls over their mean
  double seconds = 0.0;        ///< processor time
  std::vector<SurfacePoint> profile;
  std::vector<Eigen::Vector3d> position; ///< d
  std::vector<Eigen::Matrix3d> virial;   ///< k d
};

/// Presses the grain to each approach in turn (rising), by the static solver; turns and sideways motions of the grain
/// as a whole are held back. \throws std::runtime_error when a state cannot be relaxed.
std::vector<SphereState> press_sphere(const GrainTemplate& sphere, double alpha, const SurfaceRule& rule,
                                      const std::vector<double>& approaches, Press press = Press::walls);

} // namespace boba::calibration
