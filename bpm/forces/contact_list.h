// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_pair.h"
#include "bpm/forces/contact_reach.h"
#include "bpm/forces/ghost_grains.h"
#include "bpm/forces/grain_pairs.h"
#include "bpm/forces/grain_tracking.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/network_data.h"
#include "bpm/forces/pair_search.h"
#include "bpm/packing/lane_state.h"
#include "bpm/parallel/distribution.h"

#include <span>
#include <utility>
#include <vector>

namespace boba {

/// Candidate contacts of every pair of grains.
///
/// GrainTracking says where the grains are and how far their nodes deviate from that, GrainPairs which grains may meet,
/// PairSearch what their candidates are, GhostGrains what other ranks know; the list keeps count of all motion since
/// then and looks again before a contact could be missed.
///
/// Candidates are sorted by nodes, pairs by grains and image: an order that follows from the state alone.
/// Since candidates that do not touch add nothing, forces are bit for bit the same whether a pair was searched at this
/// step or earlier, by one thread or by many. (Nothing of the list needs to be stored in a checkpoint.)
/// Source: docs/decisions/contacts.md.
class ContactList {
public:
  /// Grains of other ranks near ours are followed as their owners see them (GhostGrains); update is then
  /// collective.
  ContactList(const LaneLayout& layout, const kernels::KernelTable& table, const ContactRanges& ranges, double skin,
              const Distribution& distribution = Distribution::alone());

  ContactList(const ContactList&) = delete; // its parts refer to each other
  ContactList& operator=(const ContactList&) = delete;

  /// Makes sure that no contact of the present state is missing; true when the list changed. `network_of_grain` as
  /// given at the first call.
  bool update(const LaneState& state, const Box& box, const std::vector<const NetworkData*>& network_of_grain);
  /// Tells the list that the cell was mapped by `cell_map` and that beyond that no node moved farther than `farthest`,
  /// and none that is not followed farther than `common`, d.
  void note_motion(const Matrix3& cell_map, double farthest, double common);
  /// What a node may move in a step before the list wants to hear of it, d.
  double fast_motion() const { return tracking_.fast_motion(); }
  /// True when a node is followed, so that it does not count for note_motion's `common`.
  bool follows(int grain, std::int32_t node) const { return tracking_.follows(grain, node); }
  /// Tells the list of a node that moves farther than that in a step.
  void note_fast_node(int grain, std::int32_t node) { tracking_.note_fast_node(grain, node); }
  /// The bonds of a grain that are broken, sorted: their nodes touch like any that were never bonded. All ranks then
  /// call note_broken.
  void set_broken(int grain, std::vector<kernels::NodePair> broken) { search_.set_broken(grain, std::move(broken)); }
  /// Some grain, of any rank, has other broken bonds than before.
  void note_broken() { broken_changed_ = true; }
  /// The cell's vectors or the state changed in a way that note_motion was not told of.
  void invalidate() { built_ = false; }
  /// The same, and the layout holds other grains than before.
  void layout_changed();

  std::vector<ContactPair>& pairs() { return grain_pairs_.pairs(); }
  const std::vector<ContactPair>& pairs() const { return grain_pairs_.pairs(); }
  /// The pairs a grain takes part in, in the order in which it sums them up.
  std::span<const ContactSide> sides(int grain) const { return grain_pairs_.sides(grain); }
  /// Those of them that have near candidates, in the same order; known after list_near.
  std::span<const ContactSide> near_sides(int grain) const { return near_sides_[grain]; }
  /// Nodes of a grain that are in any candidate, ascending.
  std::span<const std::int32_t> listed(int grain) const { return listed_[grain]; }
  /// True as long as no candidate can have come to touch that was not near when near candidates were last found.
  bool near_holds() const;
  /// Sets the distance below which a candidate is near from now on: chosen so that it holds for some steps of the
  /// present motion. The candidates of followed nodes are near whatever their distance.
  void begin_near();
  /// That distance for the nodes of a pair, d: nodes of the same grain touch later.
  double near_reach(const ContactPair& pair) const {
    return near_reach_ - (pair.inside() ? reach_.later_inside() : 0.0);
  }
  /// Nodes of a grain that are in any pair's near candidates, ascending; known after list_near.
  std::span<const std::int32_t> near(int grain) const { return near_[grain]; }
  /// Lists the nodes of the near candidates and the pairs that have any, once they have been found.
  void list_near();

  /// Grains of other ranks that may touch ours, ascending.
  const std::vector<int>& ghosts() const { return ghosts_.list(); }

  std::int64_t n_candidates() const;
  /// How often the list was brought up to date, a grain's nodes were noted again, a pair searched, a single node
  /// looked up, and one that is followed.
  struct Counts {
    std::int64_t updates = 0, grains = 0, pairs = 0, nodes = 0, followed = 0;
  };
  const Counts& counts() const { return counts_; }
  std::size_t bytes() const;

private:
  using Networks = std::vector<const NetworkData*>;

  bool holds() const;
  void begin_bounds(double guaranteed);
  double bring_pairs_up_to_date(const Box& box, const Networks& network_of_grain);
  void list_broken();
  void relist(int grain);
  void relist_all();
  void note_counts();
  std::vector<std::int32_t> nodes_in(int grain, std::vector<kernels::NodePair> ContactPair::*list) const;

  /// Steps for which near candidates are to hold, and what they are given at least, d.
  static constexpr double near_steps = 24.0, least_near_margin = 0.02;

  const LaneLayout& layout_;
  const Distribution& distribution_;
  ContactReach reach_;
  GrainTracking tracking_;
  PairSearch search_;
  GrainPairs grain_pairs_;
  GhostGrains ghosts_;
  bool built_ = false, broken_changed_ = false;
  Matrix3 cell_since_update_ = Matrix3::Identity();
  /// All pairs of nodes that are not listed were farther apart when the grains were last looked at, d; and those of
  /// followed nodes.
  double guaranteed_ = 0.0, followed_guaranteed_ = 0.0;
  /// Bounds on motion since then beyond the cell's, d: of a node that is not followed, and of any node.
  double motion_since_update_ = 0.0, motion_of_followed_ = 0.0;
  /// The same for near candidates: their reach, the motion of the cell and of nodes since they were found, and how far
  /// two nodes that touch may have approached each other in the last step, d.
  double near_reach_ = 0.0, motion_since_near_ = 0.0, last_approach_ = 0.0;
  Matrix3 cell_since_near_ = Matrix3::Identity();
  std::vector<std::vector<std::int32_t>> listed_, near_; ///< per grain: nodes in candidates, and in near ones
  std::vector<std::vector<ContactSide>> near_sides_;     ///< per grain
  Counts counts_;
};

} // namespace boba
