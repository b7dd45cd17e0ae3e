// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/contact_halo.h"
#include "bpm/forces/contact_laws.h"
#include "bpm/forces/contact_list.h"
#include "bpm/forces/image_bonds.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/network_data.h"
#include "bpm/forces/walls.h"
#include "bpm/laws/material.h"
#include "bpm/packing/lane_state.h"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace boba {

using kernels::Virial;

/// Symmetric tensor as xx yy zz xy xz yz.
using Tensor6 = std::array<double, 6>;

/// What one grain contributes to the stress: sigma = -(sum of virial + kinetic) / volume.
struct GrainSums {
  Tensor6 virial{};                               ///< sum of r_ij f_ij over bonds and half of each contact, k d^2
  Tensor6 kinetic{};                              ///< sum of m v v, k d^2
  double virial_trace = 0.0, kinetic_trace = 0.0; ///< the only members set by Virial::trace
};

/// Sums over all contacts of a packing.
struct ContactTotals {
  double largest_overlap = 0.0; ///< d; of node pairs and of nodes with walls
  double energy = 0.0;          ///< k d^2
  std::int64_t n_touching = 0;  ///< pairs
};

/// What the drift of a block saw: enough to know how long a contact list stays valid and whether the run has blown up.
struct BlockMotion {
  double largest_speed2 = 0.0; ///< of u (kernels::Drift), d^2/tau^2
  double common_speed2 = 0.0;  ///< bound on the same but for nodes that the contact list follows by themselves
  double checksum = 0.0;       ///< a sum of all v^2: not finite when any velocity is not
};

/// How an evaluation treats velocities and how much it sums up.
struct Evaluation {
  double kick = 0.0;      ///< v += kick f / m when a node's force is complete, tau
  double half_kick = 0.0; ///< full-step velocity = v + half_kick f / m, tau
  Virial virial = Virial::none;
  bool keep_forces = false; ///< write the forces to the state; otherwise they live in scratch only
  bool is_trial = false;    ///< of a state that is put back: bonds that break here stay whole
  /// d/dt of the cell matrix as far as it does not act on positions (remap = "velocities"): an image displaced by h n
  /// moves with rate n, and the streaming velocity is taken from the kinetic tensor.
  Matrix3 residual_rate = Matrix3::Zero();
};

/// All forces of a packing: contacts and walls first, then bonds, which finish each node and kick it.
///
/// Every grain sums the forces on its own nodes in an order that does not depend on threads.
class ForceField {
public:
  /// With several ranks, the layout holds this rank's grains; `drift` alone is not collective.
  ForceField(const Packing& packing, const LaneLayout& layout, const Material& material, double skin,
             const Distribution& distribution = Distribution::alone());

  /// The layout holds other grains than before.
  void layout_changed();
  /// The state was read from elsewhere, with what its bonds remember; see also ContactList::invalidate.
  void bonds_changed() { broken_are_known_ = false; }

  /// Moves all nodes; per block, what the drift saw.
  std::vector<BlockMotion> drift(LaneState& state, kernels::Drift drift);
  /// Rebuilds the contact list when it must, and evaluates. The sums of every grain are then known to this rank for its
  /// own grains (where asked for); `share_sums` tells all ranks.
  void evaluate(LaneState& state, const Box& box, const Evaluation& what);

  /// Gives all ranks the traces of all grains (Virial::trace), or everything (Virial::full). Collective.
  void share_sums(Virial virial);
  const std::vector<GrainSums>& grain_sums() const { return results_.grains; }
  /// Collective.
  ContactTotals contact_totals() const;
  /// Sums of the last evaluation, and a way to put them back after one that was only a probe.
  struct Results {
    std::vector<GrainSums> grains;
    std::vector<kernels::ContactSums> contacts; ///< of each grain's sides
  };
  const Results& results() const { return results_; }
  /// The same with every grain's, for all ranks. Collective.
  Results shared_results() const;
  void set_results(Results results) { results_ = std::move(results); }
  /// The node volumes of every block with alpha != 0, computed and dropped: the benchmark's share of the bond pass.
  void volumes_only(LaneState& state) const;
  /// Pairwise elastic energy of all bonds, k d^2; a pass of its own, for rare use.
  double bond_energy(const LaneState& state, const Box& box) const;
  /// Per node of a grain: how many of its bonds are whole; a pass of its own.
  std::vector<int> whole_bonds(const LaneState& state, int grain) const;
  /// Per node of a grain: the share of its bonds that are broken.
  std::vector<double> damage(const LaneState& state, int grain) const;
  /// Broken bonds of all grains. Collective.
  std::int64_t n_broken_bonds(const LaneState& state) const;
  bool bonds_break() const { return bonds_break_; }
  /// The whole bond with the largest r / r0, over all grains; a pass of its own, for rare use.
  struct Stretch {
    double ratio = 0.0;
    int grain = 0, node = 0;
  };
  Stretch largest_stretch(const LaneState& state, const Box& box) const;

  /// Distance below which nodes of different grains feel each other, d.
  double contact_range() const { return contact_->range(); }
  ContactList& contact_list() { return contact_list_; }
  const ContactList& contact_list() const { return contact_list_; }
  Walls& walls() { return walls_; }
  const Walls& walls() const { return walls_; }
  const NetworkData& network(int template_index) const { return networks_[template_index]; }
  const kernels::KernelTable& kernel_table() const { return table_; }
  bool has_periodic_template() const { return has_periodic_template_; }
  const ContactHalo& halo() const { return halo_; }

  /// Seconds spent so far; `halo`: of waiting for other ranks' nodes, and of asking for them.
  struct Seconds {
    double bonds = 0.0, contacts = 0.0, search = 0.0, halo = 0.0;
  };
  const Seconds& seconds() const { return seconds_; }

private:
  void prepare_contacts(const LaneState& state, const Box& box);
  void collect(int grain, std::span<const std::int32_t> nodes, const LaneState& state);
  struct GrainNode {
    int grain;
    std::int32_t node;
  };
  /// What the drift of some nodes of a block saw.
  struct Drifted {
    BlockMotion motion;
    std::vector<GrainNode> fast_nodes; ///< nodes that move far
  };
  Drifted drift_nodes(const Block& block, int begin, int end, LaneState& state, kernels::Drift drift);
  void note_fast_nodes(const Block& block, std::span<const std::int32_t> nodes, const LaneState& state,
                       const kernels::Drift& drift, Drifted& drifted) const;
  template <class Real> void walls_on(int b, const LaneState& state, std::size_t wall, Real* f, bool with_sums);
  kernels::ContactCandidates seen_by_kernels(const ContactPair& pair, const std::vector<kernels::NodePair>& pairs,
                                             const Box& box, const Matrix3& residual_rate) const;
  /// Finds the candidates closer than the reach, and those of followed nodes.
  void find_near(ContactPair& pair, const Box& box);
  void contacts_between(ContactPair& pair, const Box& box, const Evaluation& what);
  template <class Coordinate, class Real>
  void add_contacts(int grain, const kernels::LaneKernels<Coordinate, Real>& lane_kernels, Real* f, bool with_sums);

  // field_bonds.cpp
  /// What the passes over a block's bonds share; arrays.f holds contacts and walls before the bonds come.
  template <class Coordinate, class Real> struct BondPass {
    const Block* block;
    const NetworkData* network;
    kernels::BlockArraysOf<Coordinate, Real> arrays;
    std::array<double, max_lanes> residual_shift;
    kernels::BondParameters parameters;
    kernels::BondParametersOf<BreakingBondLaw> breaking; ///< the same for blocks whose bonds break
    std::vector<kernels::LaneSums> sums;                 ///< of each segment

    using Kernels = kernels::LaneKernels<Coordinate, Real>;
    void volumes(const Kernels& kernels, const kernels::NodeRange& range) const;
    void bonds_from_before(const Kernels& kernels, const kernels::NodeRange& range) const;
    /// With these arrays, which are those of the pass but for what a piece has of its own.
    void bonds(const Kernels& kernels, const kernels::BlockArraysOf<Coordinate, Real>& with, Virial virial,
               const kernels::NodeRange& range, std::int64_t& volumes_done, kernels::LaneSums& sums_of_range) const;
  };
  template <class Coordinate, class Real>
  BondPass<Coordinate, Real> bond_pass(int b, LaneState& state, LaneArrays<Coordinate, Real>& lanes, const Box& box,
                                       const Evaluation& what) const;
  template <class Coordinate, class Real>
  void add_others(int b, const LaneState& state, const LaneArrays<Coordinate, Real>& lanes, Real* f,
                  const Evaluation& what);
  template <class Coordinate, class Real>
  void bonds_of(int b, LaneState& state, LaneArrays<Coordinate, Real>& lanes, const Box& box, const Evaluation& what);
  template <class Coordinate, class Real>
  void split_bonds_of(const std::vector<int>& blocks, int n_pieces, LaneState& state,
                      LaneArrays<Coordinate, Real>& lanes, const Box& box, const Evaluation& what);
  template <class Coordinate, class Real> class SplitBonds;
  void sum_up(const Block& block, std::span<const kernels::LaneSums> sums, const ImageBondSums& image_sums);
  bool can_split(const std::vector<int>& blocks) const;
  void note_broken(int b, std::span<const kernels::LaneSums> sums);
  void find_broken(const LaneState& state, bool all);
  std::vector<kernels::NodePair> broken_bonds(const LaneState& state, int grain) const;

  /// Part of the pairs and blocks: those that need no other rank, and the rest.
  struct Part {
    std::vector<int> pairs, blocks;
  };
  void locate_nodes();
  void list_near(const Box& box);
  void split_by_ranks();
  void evaluate_part(const Part& part, LaneState& state, const Box& box, const Evaluation& what);
  void sum_walls();
  // With several ranks, what others ask for is looked after too.
  std::span<const std::int32_t> listed(int grain) const {
    return distribution_.is_distributed() && halo_.is_built() ? halo_.listed(grain) : contact_list_.listed(grain);
  }
  std::span<const std::int32_t> near(int grain) const {
    return distribution_.is_distributed() && halo_.is_built() ? halo_.near(grain) : contact_list_.near(grain);
  }

  const LaneLayout& layout_;
  Material material_;
  std::shared_ptr<const ContactModel> contact_; ///< between nodes of different grains, and between nodes and walls
  std::shared_ptr<const ContactModel> inner_contact_; ///< between nodes of the same grain
  const kernels::KernelTable& table_;
  std::vector<NetworkData> networks_;
  std::vector<const NetworkData*> network_of_grain_;
  ContactList contact_list_;
  Walls walls_;
  Results results_;
  Seconds seconds_;
  const Distribution& distribution_;
  ContactHalo halo_;
  Part own_part_, shared_part_;                           ///< without and with grains of other ranks
  std::vector<std::int64_t> first_node_;                  ///< per grain, in contact_nodes_
  std::unique_ptr<kernels::ContactNode[]> contact_nodes_; ///< of all nodes, kept up to date for those that are listed
  bool collected_ = false;                                ///< contact nodes are those of the present positions
  std::vector<kernels::ContactNode*> nodes_of_;           ///< node 0 of each grain that this rank knows
  std::vector<std::vector<double>> wall_forces_;          ///< per wall and grain
  bool has_periodic_template_ = false;
  bool bonds_break_ = false;         ///< of some grain of the packing, on any rank
  bool broken_are_known_ = false;    ///< to the contact list
  std::vector<char> has_new_broken_; ///< per block, in the last evaluation
};

} // namespace boba
