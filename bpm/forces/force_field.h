// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/bond_forces.h"
#include "bpm/forces/bond_survey.h"
#include "bpm/forces/contact_forces.h"
#include "bpm/forces/node_drift.h"
#include "bpm/forces/wall_forces.h"

#include <vector>

namespace boba {

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
  void bonds_changed() { bonds_.bonds_changed(); }

  /// Moves all nodes; per block, what the drift saw.
  std::vector<BlockMotion> drift(LaneState& state, const kernels::Drift& drift);
  /// Rebuilds the contact list when it must, and evaluates. The sums of every grain are then known to this rank for its
  /// own grains (where asked for); `share_sums` tells all ranks.
  void evaluate(LaneState& state, const Box& box, const Evaluation& what);

  /// Gives all ranks the traces of all grains (Virial::trace), or everything (Virial::full). Collective.
  void share_sums(Virial virial) { share_grain_sums(sums_, virial, layout_, distribution_); }
  const std::vector<GrainSums>& grain_sums() const { return sums_.grains; }
  /// Collective.
  ContactTotals contact_totals() const { return boba::contact_totals(sums_, layout_, distribution_, contact_range()); }
  /// Sums of the last evaluation, and a way to put them back after one that was only a probe.
  const ForceSums& sums() const { return sums_; }
  /// The same with every grain's, for all ranks. Collective.
  ForceSums shared_sums() const { return shared_copy(sums_, distribution_); }
  void set_sums(ForceSums sums) { sums_ = std::move(sums); }

  /// Rare passes over all bonds of the packing in this state.
  BondSurvey survey(const LaneState& state) const {
    return {bonds_.network_of_grain(), bond_law(material_), layout_, state, distribution_};
  }

  /// Distance below which nodes of different grains feel each other, d.
  double contact_range() const { return contacts_.law().range(); }
  ContactList& contact_list() { return contacts_.list(); }
  const ContactList& contact_list() const { return contacts_.list(); }
  Walls& walls() { return walls_.walls(); }
  const Walls& walls() const { return walls_.walls(); }
  const BondForces& bonds() const { return bonds_; }
  const kernels::KernelTable& kernel_table() const { return table_; }
  const ContactHalo& halo() const { return contacts_.halo(); }

  /// Seconds spent so far; `halo`: of waiting for other ranks' nodes, and of asking for them.
  struct Seconds {
    double bonds = 0.0, contacts = 0.0, search = 0.0, halo = 0.0;
  };
  const Seconds& seconds() const { return seconds_; }

private:
  class ContactsAndWalls;
  void evaluate_part(const ContactForces::Part& part, LaneState& state, const Box& box, const Evaluation& what);

  const LaneLayout& layout_;
  Material material_;
  const kernels::KernelTable& table_;
  const Distribution& distribution_;
  BondForces bonds_;
  ContactForces contacts_;
  WallForces walls_;
  ForceSums sums_;
  Seconds seconds_;
};

} // namespace boba
