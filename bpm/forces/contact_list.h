// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_search.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/network_data.h"
#include "bpm/packing/lane_layout.h"

#include <vector>

namespace boba {

/// Candidate contacts of every grain, valid until some node has moved half the skin relative to the cell's affine motion.
///
/// The list of a grain is sorted by own node, then by the other node and its image (partners in full blocks before those in
/// blocks of one lane): an order that follows from the state alone.
/// Since candidates that do not touch add nothing, forces are bit for bit the same whether the list was built at this step
/// or earlier, by one thread or by many. (Nothing of the list needs to be stored in a checkpoint.)
/// Source: docs/decisions/contacts.md.
class ContactList {
public:
  ContactList(const LaneLayout& layout, double diameter, double skin);

  void build(const LaneState& state, const Box& box, const std::vector<const NetworkData*>& network_of_grain);
  /// Tells the list that the cell was mapped by `cell_map` and that no node moved farther than `displacement` beyond that.
  void note_motion(const Matrix3& cell_map, double displacement);
  /// True when the list may miss a contact. Measures the true displacements only when the running bound says it must.
  bool expired(const LaneState& state);
  void invalidate() { built_ = false; }

  /// Candidates of one grain whose other node lives in a block of `other_stride` lanes (block_lanes or 1).
  kernels::ContactRows rows(int grain, int other_stride) const;
  int n_images() const { return static_cast<int>(images_.size()); }
  const std::vector<ImageVector>& images() const { return images_; }
  std::int64_t n_candidates() const;
  std::int64_t n_builds() const { return n_builds_; }
  std::size_t bytes() const;

private:
  struct Rows {
    std::vector<std::int32_t> own, other, image;
    std::int64_t n_wide = 0; ///< the first n_wide candidates have their other node in a full block
  };
  void sort_into_grids(const LaneState& state);
  void collect_images(const std::vector<std::vector<NeighbourGrain>>& neighbours);
  void build_rows(int grain, const std::vector<NeighbourGrain>& neighbours, const Box& box,
                  const NetworkData& network);
  double largest_displacement(const LaneState& state) const;

  const LaneLayout& layout_;
  double diameter_, skin_;
  bool built_ = false;
  Vector3 origin_ = Vector3::Zero();
  Matrix3 deformation_ = Matrix3::Identity(); ///< of the cell since the list was built
  double bound_ = 0.0;                        ///< on any node's displacement relative to that, d
  AlignedVector reference_;                   ///< positions when the list was built, lane layout
  std::vector<GrainGrid> grids_;
  std::vector<Bounds> bounds_;
  std::vector<ImageVector> images_; ///< sorted
  std::vector<Rows> rows_;
  std::int64_t n_builds_ = 0;
};

} // namespace boba
