// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_pair.h"
#include "bpm/forces/contact_reach.h"
#include "bpm/forces/network_data.h"
#include "bpm/forces/tracked_grain.h"
#include "bpm/packing/lane_layout.h"

#include <utility>
#include <vector>

namespace boba {

/// The candidates of one pair of grains: which pairs of nodes they are, and how long they hold.
///
/// A pair keeps its candidates as long as the two frames' relative motion where the grains meet, the deviations of
/// both, and what the nodes may have moved since they were last looked at are less than the skin together. A pair whose
/// grains have slid past each other is searched again from the same places.
/// Source: docs/decisions/contacts.md.
class PairSearch {
public:
  /// All arguments must outlive this object.
  PairSearch(const LaneLayout& layout, const ContactReach& reach, const std::vector<TrackedGrain>& grains)
      : layout_(layout), reach_(reach), grains_(grains) {}

  /// The layout holds other grains than before.
  void layout_changed() { broken_.assign(layout_.n_grains(), {}); }
  /// The bonds of a grain that are broken, sorted: their nodes touch like any that were never bonded.
  void set_broken(int grain, std::vector<kernels::NodePair> broken) { broken_[grain] = std::move(broken); }

  /// Brings a pair up to date with where its grains are: searched again where its candidates no longer hold, else with
  /// what moved; then with what is followed and what broke. `network` is that of grain a.
  struct Kept {
    double distance;  ///< that unlisted nodes of the pair keep at least at present, d
    bool is_searched; ///< the pair was searched again
  };
  Kept update(ContactPair& pair, const Box& box, const NetworkData& network) const;
  /// Broken bonds of a grain are always candidates. With nodes that move fast they are always near too, since that is
  /// what followed nodes are not watched for.
  void add_broken(ContactPair& pair) const;

private:
  using NodePairs = std::vector<kernels::NodePair>;

  bool holds(const ContactPair& pair) const;
  double guarantee(const ContactPair& pair, const Box& box) const;
  double radius_in(const GrainFrame& frame) const;
  GrainFrame second_frame(const ContactPair& pair, const Box& box) const;
  void search(ContactPair& pair, const Box& box, const NetworkData& network) const;
  void add_moved(ContactPair& pair, const NetworkData& network) const;
  void add_moved_inside(const ContactPair& pair, const NetworkData& network, NodePairs& found) const;
  void add_moved_between(const ContactPair& pair, NodePairs& found) const;
  void add_followed(ContactPair& pair, const Box& box, const NetworkData& network) const;
  void add_followed_inside(ContactPair& pair, const NetworkData& network) const;
  void add_followed_between(ContactPair& pair, const Box& box) const;

  const LaneLayout& layout_;
  const ContactReach& reach_;
  const std::vector<TrackedGrain>& grains_;
  std::vector<NodePairs> broken_; ///< per grain: bonds that are candidates, however far apart their nodes are
};

} // namespace boba
