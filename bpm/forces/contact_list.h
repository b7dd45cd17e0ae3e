// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_search.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/network_data.h"
#include "bpm/packing/lane_layout.h"

#include <span>
#include <vector>

namespace boba {

/// Candidate contacts of every grain.
///
/// Each node has a reference position, co-moving with the cell since the list was built, and all pairs whose references are
/// closer than diameter + skin are listed. A node that leaves its reference by nearly half the skin gets a new one,
/// and its pairs are added: a few fast nodes cost a few look-ups. Only when many nodes have done so, or the cell
/// has deformed by several per cent, everything is built anew.
///
/// The list of a grain is sorted by own node, then by the other node and its image: an order that follows from the state
/// alone. Nodes with a candidate have a slot in a compact array that the contact pass reads instead of the lanes.
/// Since candidates that do not touch add nothing, forces are bit for bit the same whether the list was built at this step
/// or earlier, by one thread or by many. (Nothing of the list needs to be stored in a checkpoint.)
/// Source: docs/decisions/contacts.md.
class ContactList {
public:
  ContactList(const LaneLayout& layout, double diameter, double skin);

  /// Makes sure that no contact of the present state is missing; true when the list changed. `network_of_grain` as given
  /// at the first call.
  bool update(const LaneState& state, const Box& box, const std::vector<const NetworkData*>& network_of_grain);
  /// Tells the list that the cell was mapped by `cell_map` and that no node moved farther than `displacement` beyond that.
  void note_motion(const Matrix3& cell_map, double displacement);
  /// The cell's vectors or the state changed in a way that note_motion was not told of.
  void invalidate() { built_ = false; }

  /// Candidates of one grain, by slots.
  kernels::ContactRows rows(int grain) const;
  /// The slots of a block's nodes and where in the lane arrays they come from.
  std::span<const kernels::ContactSource> sources(int block) const { return sources_[block]; }
  /// Slots of one grain are [first_slot, first_slot + n_slots).
  std::int32_t first_slot(int grain) const { return first_slot_[grain]; }
  std::int32_t n_slots(int grain) const { return n_slots_[grain]; }
  std::int32_t slot_capacity() const { return first_slot_.back(); }
  const std::vector<ImageVector>& images() const { return images_; }
  std::int64_t n_candidates() const;
  std::int64_t n_builds() const { return n_builds_; }
  std::int64_t n_refreshed_nodes() const { return n_refreshed_; }
  std::size_t bytes() const;

private:
  /// How far a node with a new reference may be outside its grain's bounds at the build before all is built anew, d.
  static constexpr double bounds_margin = 0.5;

  struct Rows {
    std::vector<std::int32_t> own, other, image;
  };
  /// A candidate by numbers of nodes in the packing; sorted by the members in this order.
  struct SortedPair {
    std::int32_t own, other, image;
    auto operator<=>(const SortedPair&) const = default;
  };
  /// By place in the lane arrays, so that a cache line is read once for all lanes.
  static bool by_place(const kernels::ContactSource& a, const kernels::ContactSource& b) { return a.from < b.from; }
  struct MovedNode {
    std::int32_t grain, node;
  };
  /// Nodes farther than a threshold from their reference, and the largest distance of the others.
  struct Displacements {
    std::vector<MovedNode> moved;
    double largest_rest = 0.0;
  };

  void build(const LaneState& state, const Box& box, const std::vector<const NetworkData*>& network_of_grain);
  void sort_into_grids(const LaneState& state);
  void collect_images();
  std::int32_t image_index(const ImageVector& image) const;
  void build_rows(int grain, const NetworkData& network);
  SortedPair pair_of(int grain, int node, int other, int other_node, std::int32_t image) const;
  void assign_slots();
  bool add_slots(int grain, const std::vector<SortedPair>& pairs);
  void set_rows(int grain, const std::vector<SortedPair>& sorted);

  double allowed_displacement() const;
  Displacements measure(const LaneState& state, double threshold) const;
  bool refresh(const std::vector<MovedNode>& moved, const LaneState& state,
               const std::vector<const NetworkData*>& network_of_grain);
  bool set_reference(const MovedNode& moved, const LaneState& state);
  Vector3 reference_of(int grain, int node) const;
  void find_pairs(const MovedNode& moved, const NetworkData& network,
                  std::vector<std::vector<SortedPair>>& found) const;
  void merge_rows(int grain, std::vector<SortedPair>& added);

  const LaneLayout& layout_;
  double diameter_, skin_;
  bool built_ = false;
  Vector3 origin_ = Vector3::Zero();
  Matrix3 cell_ = Matrix3::Identity();        ///< the cell matrix when the list was built
  Matrix3 deformation_ = Matrix3::Identity(); ///< of the cell since then
  double bound_ = 0.0;                        ///< on any node's distance from its reference, d
  AlignedVector reference_;                   ///< in the frame of the cell when the list was built, lane layout
  std::vector<GrainGrid> grids_; ///< over the references at the build, new ones inserted
  std::vector<Bounds> bounds_;
  std::vector<std::vector<NeighbourGrain>> neighbours_;
  std::vector<ImageVector> images_; ///< sorted; with n also -n
  std::vector<Rows> rows_;
  std::vector<std::int32_t> first_node_;               ///< per grain, in the packing
  std::vector<std::vector<SortedPair>> pairs_;         ///< of a build, until they have slots
  std::vector<std::int32_t> first_slot_;               ///< per grain, and the end; with room for new references
  std::vector<std::int32_t> n_slots_;                  ///< per grain
  std::vector<std::int32_t> node_of_slot_, slot_of_node_; ///< node in the packing; -1 for a node without candidates
  std::vector<std::vector<kernels::ContactSource>> sources_; ///< per block
  std::int64_t n_moved_ = 0, n_nodes_ = 0; ///< new references since the build; all nodes
  std::int64_t n_builds_ = 0, n_refreshed_ = 0;
};

} // namespace boba
