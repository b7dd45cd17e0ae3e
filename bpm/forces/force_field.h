// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/bond_forces.h"
#include "bpm/forces/bond_survey.h"
#include "bpm/forces/contact_forces.h"
#include "bpm/forces/node_drift.h"
#include "bpm/forces/point_contacts.h"
#include "bpm/forces/wall_forces.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
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
  /// The state was read from elsewhere, with what its bonds remember; see also forget_contacts.
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
  double contact_range() const { return contact_law().range(); }
  /// The cell was mapped by `cell_map`, and beyond that no node moved farther than `farthest`, and none that the
  /// contact list does not follow farther than `common`, d.
  void note_motion(const Matrix3& cell_map, double farthest, double common);
  /// The cell's vectors or the state changed in a way that note_motion was not told of.
  void forget_contacts();
  /// How often lists were built, grain by grain; all at once where grains are single nodes.
  std::int64_t n_list_builds() const;
  std::size_t contact_bytes() const; ///< without the halo's
  /// Of packings whose grains are not all single nodes. \throws std::bad_optional_access otherwise.
  const ContactList& contact_list() const { return contacts_.value().list(); }
  Walls& walls() { return walls_.walls(); }
  const Walls& walls() const { return walls_.walls(); }
  const BondForces& bonds() const { return bonds_; }
  const kernels::KernelTable& kernel_table() const { return table_; }
  /// What this rank has received of other ranks' nodes so far.
  ContactHalo::Traffic traffic() const { return contacts_ ? contacts_->halo().traffic() : ContactHalo::Traffic{}; }

  /// Seconds spent so far; `halo`: of waiting for other ranks' nodes, and of asking for them.
  struct Seconds {
    double bonds = 0.0, contacts = 0.0, search = 0.0, halo = 0.0;
  };
  const Seconds& seconds() const { return seconds_; }

private:
  class ContactsAndWalls;
  const ContactModel& contact_law() const { return points_ ? *point_law_ : contacts_->law(); }
  void evaluate_points(LaneState& state, const Box& box, const Evaluation& what);
  void evaluate_pairs(LaneState& state, const Box& box, const Evaluation& what);
  void evaluate_part(const ContactForces::Part& part, LaneState& state, const Box& box, const Evaluation& what);

  const LaneLayout& layout_;
  Material material_;
  const kernels::KernelTable& table_;
  const Distribution& distribution_;
  BondForces bonds_;
  // One of the two: grains of single nodes on one rank have a list of their own.
  std::optional<ContactForces> contacts_;
  std::shared_ptr<const ContactModel> point_law_;
  std::optional<PointContacts> points_;
  WallForces walls_;
  ForceSums sums_;
  Seconds seconds_;
};

} // namespace boba
