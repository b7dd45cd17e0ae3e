// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/force_sums.h"
#include "bpm/forces/wall.h"
#include "bpm/forces/walls.h"

#include <vector>

namespace boba {

/// Forces between the walls of a packing and its nodes, and their sums on each wall.
class WallForces {
public:
  /// `layout` must outlive this object.
  explicit WallForces(const LaneLayout& layout) : layout_(layout) {}

  Walls& walls() { return walls_; }
  const Walls& walls() const { return walls_; }

  /// Before an evaluation: no grain has touched a wall yet.
  void begin();
  /// Adds the forces of all walls on the grains of a block to `f`, and to the sums where asked for. One thread a block.
  template <class Real>
  void add(const PlainContact& law, const Block& block, const LaneState& state, Real* f, bool with_sums,
           ForceSums& sums);
  /// After it: tells each wall its force, summed grain by grain, so that threads and ranks do not show. Collective.
  void end(const Distribution& distribution);

private:
  const LaneLayout& layout_;
  Walls walls_;
  std::vector<std::vector<double>> forces_; ///< per wall and grain, k d
};

} // namespace boba
