// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

namespace boba {

/// What confines the nodes of a relaxation: a periodic cuboid or a field of wall forces (k d), not both.
struct Confinement {
  std::optional<Eigen::Vector3d> period;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> wall_force;
};

/// Settings of a relaxation; units d, k, m.
struct RelaxationSettings {
  double time_step = 0.1;
  int max_steps = 20000;
  double rest_force = 1e-8; ///< k d; at rest when no net force and no speed (d/tau) is larger
};

struct RelaxationResult {
  int steps = 0;
  double largest_force = 0.0; ///< k d
  double largest_speed = 0.0; ///< d/tau
  bool at_rest = false;
};

/// Moves unbonded nodes with f = k (d - r) - gamma s (e . v), s = 1 - (r/d)^8, for r < d until they rest.
///
/// Positions (d) and velocities (d/tau) are changed in place; periodic positions end in [-period/2, period/2). One
/// thread, fixed order of sums: the result depends on the arguments alone. \throws std::invalid_argument when the
/// cuboid is too small for the pair search. Source: Clemmer, Hackney & Grest, contact force without its cubic term; s
/// from the authors' published code.
RelaxationResult relax_soft_nodes(std::vector<Eigen::Vector3d>& position, std::vector<Eigen::Vector3d>& velocity,
                                  const Confinement& confinement, const RelaxationSettings& settings = {});

} // namespace boba
