// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_pair.h"
#include "bpm/forces/contact_reach.h"
#include "bpm/forces/tracked_grain.h"
#include "bpm/packing/lane_layout.h"
#include "bpm/parallel/distribution.h"

#include <span>
#include <vector>

namespace boba {

/// Which grains may meet: their pairs, sorted by grains and image, and how long no other pair can.
class GrainPairs {
public:
  /// All arguments must outlive this object.
  GrainPairs(const LaneLayout& layout, const ContactReach& reach, const Distribution& distribution)
      : layout_(layout), reach_(reach), distribution_(distribution) {}

  /// The layout holds other grains than before.
  void layout_changed();
  /// Finds the pairs of grains that are nearer than the reach and the neighbours' margin. Pairs that were there keep
  /// what they know, unless `afresh`. Collective.
  void find(std::vector<TrackedGrain>& grains, const Box& box, bool afresh);
  /// The cell was mapped.
  void note_motion(const Matrix3& cell_map) { cell_since_found_ = cell_map * cell_since_found_; }
  /// Distance that the nodes of grains which are not neighbours keep: they were farther apart than the reach when the
  /// neighbours were found, the cell may have shortened that, and each grain may have moved beyond the cell's motion.
  /// Nothing when a grain has a place that was not in its bounds then: a node that left, while the grain as a whole
  /// stayed. Collective.
  double guarantee(const std::vector<TrackedGrain>& grains, const Box& box) const;

  std::vector<ContactPair>& pairs() { return pairs_; }
  const std::vector<ContactPair>& pairs() const { return pairs_; }
  /// The pairs a grain takes part in, in the order in which it sums them up.
  std::span<const ContactSide> sides(int grain) const { return sides_[grain]; }

private:
  void share_bounds(std::vector<Bounds>& bounds) const;

  const LaneLayout& layout_;
  const ContactReach& reach_;
  const Distribution& distribution_;
  Matrix3 cell_since_found_ = Matrix3::Identity();
  std::vector<ContactPair> pairs_; ///< sorted by a, b, image
  std::vector<std::vector<ContactSide>> sides_;
};

} // namespace boba
