// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/cage/plane.h"

#include <array>

namespace boba::continuum {

/// A node of the sphere's surface in one octant, and the planes that hold it: none on a free part, one inside a
/// contact, two at an edge of the cell, three at a corner.
///
/// On a mirror the component across it is zero, so only the part of a plane's normal along the mirror counts there.
struct SurfaceNode {
  /// First of the node's three unknowns.
  long row = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::array<bool, 3> mirrored{};
  /// Integral of the node's function over the reference surface.
  double area = 0;
  /// Planes that hold the node, nearest first. Their normals are independent along the mirrors.
  std::vector<int> held;
};

/// The part of a plane's normal along the node's mirrors.
Eigen::Vector3d normal_along_mirrors(Eigen::Vector3d normal, const SurfaceNode& node);

/// Orthonormal directions of a node; the node's unknowns are taken along them. A mirrored component keeps its axis.
struct NodeFrame {
  /// Columns: the directions. Held directions come first among the columns that are no mirrored axis.
  Eigen::Matrix3d basis = Eigen::Matrix3d::Identity();
  /// Column of `basis` for each held plane, and normal . direction: normal_k = sum_j triangle(j, k) basis_column(j).
  std::array<int, 3> column{};
  Eigen::Matrix3d triangle = Eigen::Matrix3d::Zero();
};

/// Held planes first, then the others by nearness: so the frame stays when the nearest planes begin to hold the node.
NodeFrame frame_of(const SurfaceNode& node, const std::vector<Plane>& planes);

/// Displacement along the frame's held columns that puts the node on all planes that hold it, in their order.
std::vector<double> held_displacements(const SurfaceNode& node, const NodeFrame& frame,
                                       const std::vector<Plane>& planes);

/// Force on each plane that holds the node, in their order: force = sum_k f_k normal_k, compression positive.
/// force: what the material exerts on the planes at this node.
std::vector<double> plane_forces(const SurfaceNode& node, const NodeFrame& frame, const Eigen::Vector3d& force);

/// The same for every plane: planes that touch a node on a mirror alike share the force of the one that holds it.
Eigen::VectorXd shared_forces(const SurfaceNode& node, const std::vector<Plane>& planes, const Eigen::Vector3d& u,
                              const Eigen::Vector3d& force);

/// normal . (x + u) - distance: > 0 beyond the plane.
double overlap(const SurfaceNode& node, const Plane& plane, const Eigen::Vector3d& u);

/// What contradicted a node's planes: changes, and the largest pull (force) and overlap (length) among them.
struct Contradiction {
  int changes = 0;
  double pull = 0, overlap = 0;

  Contradiction& operator+=(const Contradiction& other);
};

/// Releases planes that pull and adds planes that the node has passed. smallest: differences below are no
/// contradiction. One step of the primal-dual active set. Source: Hintermueller, Ito, Kunisch, SIAM J. Optim. 13 (2003)
/// 865.
Contradiction update_planes(SurfaceNode& node, const std::vector<Plane>& planes, const Eigen::Vector3d& u,
                            const Eigen::Vector3d& force, const Contradiction& smallest);

/// The first guess at load zero: a node is held where the undeformed sphere reaches beyond half of its overlap with a
/// plane, which is where Hertz's contact ends.
void guess_planes(SurfaceNode& node, const std::vector<Plane>& planes, double radius);

} // namespace boba::continuum
