// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_halo.h"
#include "bpm/forces/contact_laws.h"
#include "bpm/forces/contact_list.h"
#include "bpm/forces/evaluation.h"
#include "bpm/forces/force_sums.h"
#include "bpm/laws/material.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boba {

/// Forces between nodes that are not bonded: copies of the nodes that may touch, which candidates are near, and the
/// force of each pair of grains.
class ContactForces {
public:
  /// `layout`, `table` and `distribution` must outlive this object.
  ContactForces(const LaneLayout& layout, const Material& material, double skin, const kernels::KernelTable& table,
                const Distribution& distribution);
  /// The layout holds other grains than before.
  void layout_changed();

  ContactList& list() { return list_; }
  const ContactList& list() const { return list_; }
  const ContactHalo& halo() const { return halo_; }
  /// Between nodes of different grains, and between nodes and walls.
  const ContactModel& law() const { return *law_; }

  /// Copies the positions and velocities of some of a grain's nodes, for the pass over the contacts.
  void collect(int grain, std::span<const std::int32_t> nodes, const LaneState& state);
  /// Nodes of a grain that may touch before the list changes, ascending: to be collected after each drift.
  std::span<const std::int32_t> near(int grain) const { return uses_halo() ? halo_.near(grain) : list_.near(grain); }
  /// All of them have been collected at the present positions.
  void note_collected() { collected_ = true; }

  /// Brings the list and the copies up to the present state, to which they belong until the next call. Collective.
  void prepare(const LaneState& state, const Box& box, const std::vector<const NetworkData*>& network_of_grain);

  /// Part of the pairs and blocks: those that need no other rank, and the rest.
  struct Part {
    std::vector<int> pairs, blocks;
  };
  const Part& own_part() const { return own_part_; }
  const Part& shared_part() const { return shared_part_; }
  /// Asks other ranks for their nodes, which `end_exchange` waits for.
  void begin_exchange() { halo_.begin(nodes_.get()); }
  void end_exchange() { halo_.end(); }

  /// Evaluates the law between the two grains of a pair and keeps the touches. Any thread, one for each pair.
  void evaluate(int pair, const Box& box, const Evaluation& what);
  /// Adds the forces that evaluate() found on a grain's nodes to `f`, and to `sums` (reset here) unless that is null.
  template <class Real> void add(int grain, Real* f, kernels::ContactSums* sums) const;

private:
  kernels::ContactCandidates seen_by_kernels(const ContactPair& pair, const std::vector<kernels::NodePair>& pairs,
                                             const Box& box, const Matrix3& residual_rate) const;
  /// Finds the candidates closer than the reach, and those of followed nodes.
  void find_near(ContactPair& pair, const Box& box);
  void locate_nodes();
  void list_near(const Box& box);
  void split_by_ranks();
  // With several ranks, what others ask for is looked after too.
  bool uses_halo() const { return distribution_.is_distributed() && halo_.is_built(); }
  std::span<const std::int32_t> listed(int grain) const {
    return uses_halo() ? halo_.listed(grain) : list_.listed(grain);
  }

  const LaneLayout& layout_;
  const kernels::KernelTable& table_;
  const Distribution& distribution_;
  std::shared_ptr<const ContactModel> law_;
  std::shared_ptr<const ContactModel> inner_law_; ///< between nodes of the same grain
  ContactList list_;
  ContactHalo halo_;
  Part own_part_, shared_part_;                   ///< without and with grains of other ranks
  std::vector<std::int64_t> first_node_;          ///< per grain, in nodes_
  std::unique_ptr<kernels::ContactNode[]> nodes_; ///< of all nodes, kept up to date for those that are listed
  bool collected_ = false;                        ///< the copies are those of the present positions
  std::vector<kernels::ContactNode*> nodes_of_;   ///< node 0 of each grain that this rank knows
};

} // namespace boba
