// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/grain_frame.h"
#include "bpm/forces/grain_grid.h"

#include <cstdint>
#include <vector>

namespace boba {

/// What a contact list knows of where a grain's nodes are. A node's place is where it was noted, seen from the frame.
struct TrackedGrain {
  GrainFrame frame;                              ///< from noted places to space
  GrainFrame neighbour_frame;                    ///< the same when the grain's neighbours were found
  Bounds neighbour_bounds;                       ///< in space, at that time, of all places that it may have
  bool outgrown = false;                         ///< a place is outside them
  GrainGrid grid;                                ///< over the noted places, new ones inserted
  Matrix3 inverse_moments = Matrix3::Identity(); ///< of sum X (x) X over the nodes as first noted
  double deviation = 0.0;                        ///< largest distance of a node from where the frame puts it, d
  std::vector<std::int32_t> moved;    ///< nodes with a new place since the pairs were last brought up to date
  std::vector<Vector3> moved_to;      ///< those places
  int n_moved = 0;                    ///< since all were noted
  bool all_noted = false;             ///< all were noted since the pairs were last brought up to date
  std::vector<std::int32_t> followed; ///< nodes that are followed by themselves, ascending
  std::vector<int> updates_left;      ///< for which each of them stays so
  std::vector<Vector3> followed_at;   ///< where they were at the last update, seen in the frame
  std::vector<std::int32_t> fast;     ///< nodes that moved far in a step since then, as they came
  bool too_many_fast = false;         ///< they were too many for any to be followed

  /// Notes whether a place was outside the bounds that the grain had when its neighbours were found.
  void compare_with_neighbour_bounds(const Vector3& place) {
    outgrown = outgrown || !neighbour_bounds.contains(neighbour_frame(place));
  }
};

} // namespace boba
