// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_forces.h"

#include <vector>

namespace boba {

/// What the drift of a block saw: enough to know how long a contact list stays valid and whether the run has blown up.
struct BlockMotion {
  double largest_speed2 = 0.0; ///< of u (kernels::Drift), d^2/tau^2
  double common_speed2 = 0.0;  ///< bound on the same but for nodes that the contact list follows by themselves
  double checksum = 0.0;       ///< a sum of all v^2: not finite when any velocity is not
};

/// Moves all nodes, x = M x + dt v, and while they are in the cache copies those that may touch for the contact pass.
/// Tells the contact list of nodes that move far. Returns, per block, what the drift saw. Not collective.
/// Cost: 9 multiplications and 12 additions per node and lane.
std::vector<BlockMotion> drift_nodes(const LaneLayout& layout, const kernels::KernelTable& table, LaneState& state,
                                     kernels::Drift drift, ContactForces& contacts);

/// The same for grains of single nodes, whose contacts look at the nodes by themselves.
std::vector<BlockMotion> drift_points(const LaneLayout& layout, const kernels::KernelTable& table, LaneState& state,
                                      const kernels::Drift& drift);

} // namespace boba
