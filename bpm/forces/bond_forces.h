// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/bond_pass.h"
#include "bpm/forces/contact_list.h"
#include "bpm/forces/evaluation.h"
#include "bpm/forces/force_sums.h"
#include "bpm/forces/image_bonds.h"
#include "bpm/forces/network_data.h"
#include "bpm/laws/material.h"
#include "bpm/packing/packing.h"

#include <span>
#include <vector>

namespace boba {

/// Adds to the forces on a block's nodes, which are zero, what does not come from bonds.
class OtherForces {
public:
  virtual ~OtherForces() = default;
  virtual void add(int block, double* f) = 0;
  virtual void add(int block, float* f) = 0;
};

/// What one evaluation of the bonds reads and writes.
struct BondEvaluation {
  LaneState& state;
  const Box& box;
  const Evaluation& what;
  OtherForces& others; ///< called once for each block, before its bonds
  ForceSums& sums;     ///< of the block's grains, complete afterwards where asked for
};

/// Forces of the bonds of all grains: a block by one thread, or, where there are fewer blocks than threads want, in
/// pieces by several; the same to the last bit. The pass over a node's last bond also kicks the node.
class BondForces {
public:
  /// `layout` and `table` must outlive this object.
  /// \throws std::invalid_argument for networks bonded across the cell's boundary that break or are in mixed precision.
  BondForces(const Packing& packing, const LaneLayout& layout, const Material& material,
             const kernels::KernelTable& table);

  const std::vector<const NetworkData*>& network_of_grain() const { return network_of_grain_; }
  bool has_periodic_template() const { return has_periodic_template_; }
  bool can_break() const { return can_break_; } ///< of some grain of the packing, on any rank
  bool can_yield() const { return can_yield_; } ///< the same
  /// The layout or the state changed, with what its bonds remember.
  void bonds_changed() { broken_are_known_ = false; }
  /// Tells the contact list of the bonds that broke since the last call: their nodes touch from now on. Collective.
  void report_broken(ContactList& list, const LaneState& state, const Ranks& ranks);

  /// True when each of these blocks can be shared by several threads.
  bool can_split(const std::vector<int>& blocks) const;
  /// The forces on a block, by one thread; for any number of blocks at once.
  void evaluate(int block, const BondEvaluation& evaluation);
  /// The forces on some blocks, each in so many pieces, by all threads; outside of parallel regions.
  void evaluate_split(const std::vector<int>& blocks, int n_pieces, const BondEvaluation& evaluation);
  /// The node volumes of every block with alpha != 0, computed and dropped: the benchmark's share of the bond pass.
  void volumes_only(LaneState& state) const;

private:
  template <class Coordinate, class Real>
  void evaluate_block(int b, LaneArrays<Coordinate, Real>& lanes, const BondEvaluation& evaluation);
  template <class Coordinate, class Real>
  void evaluate_pieces(const std::vector<int>& blocks, int n_pieces, LaneArrays<Coordinate, Real>& lanes,
                       const BondEvaluation& evaluation);
  template <class Coordinate, class Real>
  BondPass<Coordinate, Real> pass_of(int b, LaneArrays<Coordinate, Real>& lanes,
                                     const BondEvaluation& evaluation) const;
  void note_broken(int b, std::span<const kernels::LaneSums> sums);

  const LaneLayout& layout_;
  Material material_;
  const kernels::KernelTable& table_;
  std::vector<NetworkData> networks_; ///< per template
  std::vector<const NetworkData*> network_of_grain_;
  bool has_periodic_template_ = false;
  bool can_break_ = false, can_yield_ = false;
  bool broken_are_known_ = false;    ///< to the contact list
  std::vector<char> has_new_broken_; ///< per block, in the last evaluation
};

} // namespace boba
