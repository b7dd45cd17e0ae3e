// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_pair.h"
#include "bpm/forces/contact_search.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/network_data.h"
#include "bpm/packing/lane_state.h"
#include "bpm/parallel/distribution.h"
#include "bpm/parallel/star_forest.h"

#include <memory>
#include <span>
#include <vector>

namespace boba {

struct GhostRecord;
struct PlaceRecord;

/// Distances below which two unbonded nodes touch, d.
struct ContactRanges {
  double between = 1.0; ///< of different grains, or of a grain and an image of itself
  double inside = 1.0;  ///< of the same grain; at most `between`
};

/// Candidate contacts of every pair of grains.
///
/// A grain's nodes are noted once by their places in its frame, an affine map that is fitted to the grain again and
/// again: what is left is how far a node deviates from where the frame puts it. A pair of grains keeps its candidates
/// as long as the two frames' relative motion where they meet, the deviations of both, and what the nodes may have
/// moved since they were last looked at are less than the skin together. A node that deviates far gets a new place and
/// is looked up once; a pair whose grains have slid past each other is searched again from the same places; only a
/// grain that has changed its shape notes all its places again. The few nodes that move much faster than the rest are
/// followed by themselves: they are looked up from where they are, with a reach of their own.
///
/// Candidates are sorted by nodes, pairs by grains and image: an order that follows from the state alone.
/// Since candidates that do not touch add nothing, forces are bit for bit the same whether a pair was searched at this
/// step or earlier, by one thread or by many. (Nothing of the list needs to be stored in a checkpoint.)
/// Source: docs/decisions/contacts.md.
class ContactList {
public:
  /// Grains of other ranks near ours are followed as their owners see them (contact_ghosts.cpp); update is then
  /// collective.
  ContactList(const LaneLayout& layout, const kernels::KernelTable& table, const ContactRanges& ranges, double skin,
              const Distribution& distribution = Distribution::alone());

  /// Makes sure that no contact of the present state is missing; true when the list changed. `network_of_grain` as
  /// given at the first call.
  bool update(const LaneState& state, const Box& box, const std::vector<const NetworkData*>& network_of_grain);
  /// Tells the list that the cell was mapped by `cell_map` and that beyond that no node moved farther than `farthest`,
  /// and none that is not followed farther than `common`, d.
  void note_motion(const Matrix3& cell_map, double farthest, double common);
  /// What a node may move in a step before the list wants to hear of it, d.
  double fast_motion() const { return fast_motion_; }
  /// True when a node is followed, so that it does not count for note_motion's `common`.
  bool follows(int grain, std::int32_t node) const;
  /// Tells the list of a node that moves farther than that in a step.
  void note_fast_node(int grain, std::int32_t node);
  /// The bonds of a grain that are broken, sorted: their nodes touch like any that were never bonded. All ranks then
  /// call note_broken.
  void set_broken(int grain, std::vector<kernels::NodePair> broken) { grains_[grain].broken = std::move(broken); }
  /// Some grain, of any rank, has other broken bonds than before.
  void note_broken() { broken_changed_ = true; }
  /// The cell's vectors or the state changed in a way that note_motion was not told of.
  void invalidate() { built_ = false; }
  /// The same, and the layout holds other grains than before.
  void layout_changed();

  std::vector<ContactPair>& pairs() { return pairs_; }
  const std::vector<ContactPair>& pairs() const { return pairs_; }
  /// The pairs a grain takes part in, in the order in which it sums them up.
  std::span<const ContactSide> sides(int grain) const { return sides_[grain]; }
  /// Those of them that have near candidates, in the same order; known after list_near.
  std::span<const ContactSide> near_sides(int grain) const { return near_sides_[grain]; }
  /// Nodes of a grain that are in any candidate, ascending.
  std::span<const std::int32_t> listed(int grain) const { return grains_[grain].listed; }
  /// True as long as no candidate can have come to touch that was not near when near candidates were last found.
  bool near_holds() const;
  /// Sets the distance below which a candidate is near from now on: chosen so that it holds for some steps of the
  /// present motion. The candidates of followed nodes are near whatever their distance.
  void begin_near();
  /// That distance for the nodes of a pair, d: nodes of the same grain touch later.
  double near_reach(const ContactPair& pair) const { return near_reach_ - (pair.inside() ? later_inside() : 0.0); }
  /// Nodes of a grain that are in any pair's near candidates, ascending; known after list_near.
  std::span<const std::int32_t> near(int grain) const { return grains_[grain].near; }
  /// Lists the nodes of the near candidates and the pairs that have any, once they have been found.
  void list_near();

  /// Grains of other ranks that may touch ours, ascending.
  const std::vector<int>& ghosts() const { return ghosts_; }

  std::int64_t n_candidates() const;
  /// How often the list was brought up to date, a grain's nodes were noted again, a pair searched, a single node
  /// looked up, and one that is followed.
  struct Counts {
    std::int64_t updates = 0, grains = 0, pairs = 0, nodes = 0, followed = 0;
  };
  const Counts& counts() const { return counts_; }
  std::size_t bytes() const;

private:
  struct TrackedGrain {
    GrainFrame frame;                              ///< from noted places to space
    GrainFrame neighbour_frame;                    ///< the same when the grain's neighbours were found
    Bounds neighbour_bounds;                       ///< in space, at that time, of all places that it may have
    bool outgrown = false;                         ///< a place is outside them
    GrainGrid grid;                                ///< over the noted places, new ones inserted
    Matrix3 inverse_moments = Matrix3::Identity(); ///< of sum X (x) X over the nodes as first noted
    double deviation = 0.0;                        ///< largest distance of a node from where the frame puts it, d
    std::vector<std::int32_t> moved; ///< nodes with a new place since the pairs were last brought up to date
    std::vector<Vector3> moved_to;   ///< those places
    int n_moved = 0;                 ///< since all were noted
    bool all_noted = false;          ///< all were noted since the pairs were last brought up to date
    std::vector<std::int32_t> listed, near;
    std::vector<std::int32_t> followed;    ///< nodes that are followed by themselves, ascending
    std::vector<int> updates_left;         ///< for which each of them stays so
    std::vector<Vector3> followed_at;      ///< where they were at the last update, seen in the frame
    std::vector<std::int32_t> fast;        ///< nodes that moved far in a step since then, as they came
    bool too_many_fast = false;            ///< they were too many for any to be followed
    std::vector<kernels::NodePair> broken; ///< bonds that are candidates, however far apart their nodes are
  };
  using Networks = std::vector<const NetworkData*>;
  using NodePairs = std::vector<kernels::NodePair>;

  double reach_between() const { return diameter_ + skin_between_; }
  double reach_inside() const { return inner_diameter_ + skin_; }
  /// Distances inside a grain count as larger by this, and are then compared with those between grains.
  double later_inside() const { return diameter_ - inner_diameter_; }
  double reserve() const { return reserve_share * skin_; }

  /// Share of the skin that is left for motion between two looks at the grains.
  static constexpr double reserve_share = 0.3;
  /// Share of the skin beyond which a node that deviates gets a new place.
  static constexpr double far_share = 0.3;
  /// Skin between grains over the skin inside a grain, where nodes are denser and move less.
  static constexpr double between_share = 1.6;
  /// How far a node with a new place may be outside its grain's bounds before all are noted again, d.
  double bounds_margin_ = 0.5;
  /// Margin of the list of neighbouring grains, d.
  double neighbour_margin_ = 1.0;
  /// Steps for which near candidates are to hold, and what they are given at least, d.
  static constexpr double near_steps = 24.0, least_near_margin = 0.02;
  /// Most that a frame may shorten before all is noted again.
  static constexpr double largest_shortening = 0.05;

  // contact_list.cpp: pairs
  static double kept_distance(double distance, const Matrix3& cell, double moved);
  double radius_in(const GrainFrame& frame) const;
  void search(ContactPair& pair, const Box& box, const NetworkData& network);
  void add_moved(ContactPair& pair, const NetworkData& network);
  void add_moved_inside(const ContactPair& pair, const NetworkData& network, NodePairs& found) const;
  void add_moved_between(const ContactPair& pair, NodePairs& found) const;
  /// Adds the unbonded pairs of a node with those of its grain that are near a place where it is seen.
  static void add_partners_inside(const TrackedGrain& grain, std::int32_t node, const Vector3& place, double radius,
                                  const NetworkData& network, NodePairs& pairs);
  static void remove_bonded(const ContactPair& pair, NodePairs& list, const NetworkData& network);
  void add_broken(ContactPair& pair);
  void list_broken();
  static void add_candidates(ContactPair& pair, NodePairs& found, const NetworkData& network);
  bool search_holds(const ContactPair& pair) const;
  double guarantee(const ContactPair& pair, const Box& box) const;
  double bring_pairs_up_to_date(const Box& box, const Networks& network_of_grain);
  void relist(int grain);
  void relist_all();
  void note_counts();
  std::vector<std::int32_t> nodes_in(int grain, std::vector<kernels::NodePair> ContactPair::*list) const;
  GrainFrame second_frame(const ContactPair& pair, const Box& box) const;

  // contact_neighbours.cpp: which grains may meet
  void find_neighbours(const Box& box);
  double neighbour_guarantee(const Box& box) const;
  static void compare_with_neighbour_bounds(TrackedGrain& grain, const Vector3& place);

  // contact_following.cpp: nodes that are followed by themselves
  void follow(int grain, const LaneState& state);
  void choose_fast_motion();
  void add_followed(ContactPair& pair, const Box& box, const NetworkData& network);
  void add_followed_inside(ContactPair& pair, const NetworkData& network) const;
  void add_followed_between(ContactPair& pair, const Box& box) const;
  double followed_guarantee() const;

  // contact_ghosts.cpp: grains of other ranks
  void share_bounds(std::vector<Bounds>& bounds) const;
  void find_ghosts();
  void follow_ghosts();
  struct GhostMessage;
  GhostMessage message_of_own_grains() const;
  GhostMessage message_about_ghosts(const GhostMessage& own) const;
  const PlaceRecord* take_ghost(int ghost, const GhostRecord& record, bool all, const PlaceRecord* next);

  // contact_tracking.cpp: grains
  void track(const LaneState& state);
  void track_block(int b, const LaneState& state);
  /// Fits the frames of a block; returns which lanes are to look how far.
  kernels::LaneFrames fit_frames(int b, const LaneState& state);
  void note_all(int grain, const LaneState& state);
  bool note_moved(int grain, const LaneState& state);
  bool out_of_shape(const TrackedGrain& grain, int n_nodes) const;
  Vector3 place(int grain, int node) const;

  const LaneLayout& layout_;
  const kernels::KernelTable& table_;
  double diameter_, inner_diameter_, skin_, skin_between_;
  bool built_ = false, broken_changed_ = false;
  Matrix3 cell_since_tracking_ = Matrix3::Identity(), cell_since_neighbours_ = Matrix3::Identity();
  /// All pairs of nodes that are not listed were farther apart when the grains were last tracked, d; and those of
  /// followed nodes.
  double guaranteed_ = 0.0, followed_guaranteed_ = 0.0;
  double motion_since_update_ =
      0.0;                          ///< bound on a node's motion since then beyond the cell's, d, but for followed ones
  double motion_of_followed_ = 0.0; ///< the same of any node
  double fast_motion_;              ///< d a step
  /// The same for near candidates: their reach, the motion of the cell and of nodes since they were found, and how far
  /// two nodes that touch may have approached each other in the last step, d.
  double near_reach_ = 0.0, motion_since_near_ = 0.0, last_approach_ = 0.0;
  Matrix3 cell_since_near_ = Matrix3::Identity();
  AlignedArray<float> place_; ///< X, lane layout, d
  std::vector<TrackedGrain> grains_;
  std::vector<ContactPair> pairs_;                           ///< sorted by a, b, image
  std::vector<std::vector<ContactSide>> sides_, near_sides_; ///< per grain
  const Distribution& distribution_;
  std::vector<int> ghosts_;
  std::vector<std::uint8_t> fresh_;          ///< per ghost: nothing of it is known yet
  std::vector<std::uint8_t> wanted_;         ///< per own grain: some rank knows nothing of it yet
  std::unique_ptr<StarForest> ghost_forest_; ///< own grains to ghosts
  Counts counts_;
};

} // namespace boba
