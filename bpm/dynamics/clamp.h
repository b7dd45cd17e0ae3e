// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/lane_state.h"
#include "bpm/parallel/distribution.h"

#include <cstdint>
#include <vector>

namespace boba {

/// A set of nodes that moves rigidly at a given velocity.
/// Source: docs/notation.md, "Clamp".
struct Clamp {
  std::vector<std::int64_t> grain, node; ///< of each clamped node
  Vector3 velocity = Vector3::Zero();
  Vector3 force = Vector3::Zero(); ///< of the other nodes on the clamped ones at the last step, k d
};

/// The nodes of this rank's grains whose z lies in [low, high].
Clamp clamp_between(double low, double high, const LaneLayout& layout, const LaneState& state);

/// Takes the clamped nodes' forces into `clamp.force` and gives the nodes the clamp's velocity and no force. Nodes of
/// other ranks' grains are theirs to do; all ranks know the force. Collective.
void apply_clamp(Clamp& clamp, const LaneLayout& layout, LaneState& state, const Distribution& distribution);

/// All ranks' parts of a clamp, sorted by grain and node, on all ranks. Collective.
void share_clamp(Clamp& clamp, const Distribution& distribution, int n_grains);

} // namespace boba
