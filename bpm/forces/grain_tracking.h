// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_reach.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/tracked_grain.h"
#include "bpm/packing/lane_state.h"

#include <cstdint>
#include <vector>

namespace boba {

/// Follows grains with frames, affine maps that are fitted to their nodes again and again: what is left is how far a
/// node deviates from where the frame puts it. A node that deviates far gets a new place; only a grain that has changed
/// its shape notes all its places again. The few nodes that move much faster than the rest are followed by themselves.
/// Source: docs/decisions/contacts.md.
class GrainTracking {
public:
  /// `layout`, `table` and `reach` must outlive this object.
  GrainTracking(const LaneLayout& layout, const kernels::KernelTable& table, const ContactReach& reach);

  /// The layout holds other grains than before.
  void layout_changed();
  /// Looks at all grains of this rank; `afresh`: nothing of what was noted before counts.
  void look(const LaneState& state, bool afresh);
  /// The pairs of grains have been brought up to date with what was noted.
  void forget_news();

  /// What a node may move in a step before it counts as fast, d.
  double fast_motion() const { return fast_motion_; }
  /// True when a node is followed by itself.
  bool follows(int grain, std::int32_t node) const;
  /// Tells of a node that moves farther than fast_motion in a step.
  void note_fast_node(int grain, std::int32_t node);
  /// Sets what counts as far so that a few nodes in a thousand are followed.
  void choose_fast_motion();
  /// Distance that followed nodes keep from all that they are not listed with: they were looked up from where they are
  /// with the whole reach, and others may deviate from their places.
  double followed_guarantee() const;

  /// Of all grains of the packing; those of other ranks are what their owners say (GhostGrains).
  std::vector<TrackedGrain>& grains() { return grains_; }
  const std::vector<TrackedGrain>& grains() const { return grains_; }
  const TrackedGrain& operator[](int grain) const { return grains_[grain]; }
  /// Where a node of a grain of this rank was noted, seen from the grain's frame.
  Vector3 place(int grain, int node) const;
  std::size_t bytes() const;

private:
  void look_at_block(int b, const LaneState& state);
  /// Fits the frames of a block; returns which lanes are to look how far.
  kernels::LaneFrames fit_frames(int b, const LaneState& state);
  void note_all(int grain, const LaneState& state);
  bool note_moved(int grain, const LaneState& state);
  bool out_of_shape(const TrackedGrain& grain, int n_nodes) const;
  void follow(int grain, const LaneState& state);

  const LaneLayout& layout_;
  const kernels::KernelTable& table_;
  const ContactReach& reach_;
  double fast_motion_;        ///< d a step
  AlignedArray<float> place_; ///< X, lane layout, d
  std::vector<TrackedGrain> grains_;
};

} // namespace boba
