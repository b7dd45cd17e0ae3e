// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_pair.h"
#include "bpm/forces/contact_reach.h"
#include "bpm/forces/grain_tracking.h"
#include "bpm/parallel/distribution.h"
#include "bpm/parallel/star_forest.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace boba {

struct GhostRecord;
struct PlaceRecord;

/// Grains of other ranks near ours. Their owners follow them; what they know of frames, places and deviations comes
/// here whenever the grains are looked at, so that pairs are searched and kept by the same rules on both sides. All is
/// collective, and does nothing on one rank.
class GhostGrains {
public:
  /// All arguments must outlive this object.
  GhostGrains(const LaneLayout& layout, const ContactReach& reach, const Distribution& distribution)
      : layout_(layout), reach_(reach), distribution_(distribution) {}

  /// The layout holds other grains than before.
  void layout_changed() { ghosts_.clear(); }
  /// Finds out which grains of other ranks stand in these pairs, and which of ours other ranks know nothing of yet;
  /// `afresh`: nothing that was known counts.
  void find(const std::vector<ContactPair>& pairs, std::vector<TrackedGrain>& grains, bool afresh);
  /// Brings frames, deviations and places of the ghosts up to what their owners have just found.
  void follow(GrainTracking& tracking);

  /// Grains of other ranks that may touch ours, ascending.
  const std::vector<int>& list() const { return ghosts_; }

private:
  struct Message;
  Message message_of_own_grains(const GrainTracking& tracking) const;
  Message message_about_ghosts(const Message& own) const;
  const PlaceRecord* take(TrackedGrain& grain, int ghost, const GhostRecord& record, bool all,
                          const PlaceRecord* next) const;

  const LaneLayout& layout_;
  const ContactReach& reach_;
  const Distribution& distribution_;
  std::vector<int> ghosts_;
  std::vector<std::uint8_t> fresh_;    ///< per ghost: nothing of it is known yet
  std::vector<std::uint8_t> wanted_;   ///< per own grain: some rank knows nothing of it yet
  std::unique_ptr<StarForest> forest_; ///< own grains to ghosts
};

} // namespace boba
