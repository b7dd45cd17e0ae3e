// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace boba {

/// What does not change during a run: which node belongs to which grain, and the bonds.
///
/// Nodes of a grain are consecutive, grains are in order of their number: grain g owns the nodes
/// [first_node[g], first_node[g + 1]). Node numbers here run from 0; `id` is what files show.
struct Topology {
  std::vector<std::int64_t> first_node; ///< size n_grains + 1
  std::vector<std::int64_t> id;         ///< per node; 1 .. n unless the data came from a file with other numbers
  std::vector<std::int64_t> molecule;   ///< per grain; the number files show (1 .. n_grains unless read from a file)
  std::vector<int> species;             ///< per grain
  std::vector<double> alpha;            ///< per grain, k d
  std::vector<int> template_index;      ///< per grain; equal numbers mean the same undeformed network
  struct Pair {
    std::int64_t i, j;
    double r0;
  };
  std::vector<Pair> bonds; ///< global node numbers; r0 in d
  /// Per template: nodes of the undeformed grain (all bonds at rest), d. Empty, as a whole or one, where not known.
  std::vector<std::vector<Vector3>> undeformed;

  std::int64_t n_nodes() const { return static_cast<std::int64_t>(id.size()); }
  int n_grains() const { return static_cast<int>(first_node.size()) - 1; }
  std::vector<int> grain_of_node() const;
};

/// The state of a packing at one step, in plain arrays indexed by global node number: what every writer and every
/// measure reads. Positions are unwrapped; the image flags of a file are `box.image_of(x)`.
struct Snapshot {
  /// The grains whose nodes the arrays of nodes hold, one after the other; empty where that is all of them.
  std::vector<int> grains;
  std::int64_t step = 0;
  double time = 0.0;   ///< tau
  double strain = 0.0; ///< accumulated shear strain, with that of the cell's motion at the end of the step
  /// Shear rate that images move with while positions do not follow (remap = "velocities"), 1/tau; else 0.
  double streaming_rate = 0.0;
  Box box;
  std::vector<Vector3> position; ///< d
  std::vector<Vector3> velocity; ///< d/tau, full step; empty when not asked for
  std::vector<Vector3> force;    ///< k d; empty when not asked for
  /// Per node of the whole packing: share of its bonds that are broken. Empty where bonds do not break, and on other
  /// ranks than rank 0.
  std::vector<double> damage;
  std::vector<Vector3> grain_centre; ///< d, unwrapped mean of the grain's nodes
  /// Each grain's own part of the stress, times the box volume (so the sum over grains / volume is the stress); k d,
  /// components xx yy zz xy xz yz, tension positive, kinetic part included.
  std::vector<std::array<double, 6>> grain_stress;

  std::span<const Vector3> nodes_of(const Topology& topology, int grain) const {
    return std::span(position).subspan(topology.first_node[grain],
                                       topology.first_node[grain + 1] - topology.first_node[grain]);
  }
};

} // namespace boba
