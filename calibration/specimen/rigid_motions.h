// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace boba::calibration {

/// Rigid motions of a set of nodes: translations along x, y, z and small turns about axes through their mean.
class RigidMotions {
public:
  RigidMotions() = default;
  /// `chosen`: which of x, y, z and the turns about x, y, z; of each of `n_bodies` equal runs of nodes by itself.
  RigidMotions(const std::vector<Eigen::Vector3d>& position, const std::array<bool, 6>& chosen, int n_bodies = 1);

  /// Removes the chosen motions from a field of one vector a node (orthogonal projection).
  void take_out(std::vector<Eigen::Vector3d>& field) const;

private:
  std::vector<std::vector<Eigen::Vector3d>> motion_; // orthonormal
};

} // namespace boba::calibration
