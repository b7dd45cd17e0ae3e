// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/force_field.h"

#include "bpm/forces/block_pieces.h"

#include <numeric>
#include <omp.h>

namespace boba {

ForceField::ForceField(const Packing& packing, const LaneLayout& layout, const Material& material, double skin,
                       const Distribution& distribution)
    : layout_(layout), material_(material), table_(kernels::best_table()), distribution_(distribution),
      bonds_(packing, layout, material, table_), walls_(layout) {
  if (!distribution.is_distributed() && PointContacts::serves(layout)) {
    point_law_ = contact_model(between_grains(material));
    points_.emplace(layout, *point_law_, skin);
  } else {
    contacts_.emplace(layout, material, skin, table_, distribution);
  }
  layout_changed();
}

void ForceField::layout_changed() {
  sums_.reset(layout_.n_grains());
  points_ ? points_->layout_changed() : contacts_->layout_changed();
  bonds_.bonds_changed();
}

void ForceField::note_motion(const Matrix3& cell_map, double farthest, double common) {
  if (contacts_) {
    contacts_->list().note_motion(cell_map, farthest, common);
  }
}

void ForceField::forget_contacts() {
  points_ ? points_->layout_changed() : contacts_->list().invalidate();
}

std::int64_t ForceField::n_list_builds() const {
  return points_ ? points_->n_builds() : contacts_->list().counts().grains;
}

std::size_t ForceField::contact_bytes() const {
  return points_ ? points_->bytes() : contacts_->list().bytes();
}

std::vector<BlockMotion> ForceField::drift(LaneState& state, const kernels::Drift& drift) {
  return points_ ? drift_points(layout_, table_, state, drift) : drift_nodes(layout_, table_, state, drift, *contacts_);
}

/// Contacts and walls of a block's grains.
class ForceField::ContactsAndWalls final : public OtherForces {
public:
  ContactsAndWalls(ForceField& field, const LaneState& state, bool with_sums)
      : field_(field), state_(state), with_sums_(with_sums) {}
  void add(int block, double* f) override { add_to(block, f); }
  void add(int block, float* f) override { add_to(block, f); }

private:
  template <class Real> void add_to(int b, Real* f) {
    const Block& block = field_.layout_.blocks()[b];
    if (field_.points_) {
      field_.points_->add(block, f);
    }
    for (int lane = 0; field_.contacts_ && lane < block.n_lanes; ++lane) {
      if (const int grain = block.grain[lane]; grain >= 0) {
        field_.contacts_->add(grain, f + lane, with_sums_ ? &field_.sums_.contacts[grain] : nullptr);
      }
    }
    if (field_.material_.gravity != std::array<double, 3>{}) {
      add_gravity(block, f);
    }
    field_.walls_.add(field_.contact_law(), block, state_, f, with_sums_, field_.sums_);
  }

  /// m g on every node.
  template <class Real> void add_gravity(const Block& block, Real* f) const {
    for (int c = 0; c < 3; ++c) {
      const auto weight = static_cast<Real>(field_.material_.node_mass * field_.material_.gravity[c]);
      for (std::int64_t node = 0; node < block.n_nodes; ++node) {
        Real* of_node = f + (3 * node + c) * block.n_lanes;
        for (int lane = 0; lane < block.n_lanes; ++lane) {
          of_node[lane] += block.grain[lane] >= 0 ? weight : Real{0};
        }
      }
    }
  }

  ForceField& field_;
  const LaneState& state_;
  bool with_sums_;
};

void ForceField::evaluate_part(const ContactForces::Part& part, LaneState& state, const Box& box,
                               const Evaluation& what) {
  const double start = omp_get_wtime();
  double kicked = 0.0;
  const int n_pieces = pieces_of(static_cast<int>(part.blocks.size()), omp_get_max_threads());
  const bool split = n_pieces > 1 && bonds_.can_split(part.blocks);
  ContactsAndWalls others(*this, state, what.virial != Virial::none);
  const BondEvaluation bonds = {state, box, what, others, sums_};
#pragma omp parallel
  {
#pragma omp for schedule(dynamic, 4)
    for (const int p : part.pairs) {
      contacts_->evaluate(p, box, what);
    }
#pragma omp master
    kicked = omp_get_wtime();
    if (!split) {
#pragma omp for schedule(dynamic, 1)
      for (const int b : part.blocks) {
        bonds_.evaluate(b, bonds);
      }
    }
  }
  if (split) {
    bonds_.evaluate_split(part.blocks, n_pieces, bonds);
  }
  seconds_.contacts += kicked - start;
  seconds_.bonds += omp_get_wtime() - kicked;
}

void ForceField::evaluate(LaneState& state, const Box& box, const Evaluation& what) {
  walls_.begin();
  points_ ? evaluate_points(state, box, what) : evaluate_pairs(state, box, what);
  walls_.end(distribution_);
}

void ForceField::evaluate_points(LaneState& state, const Box& box, const Evaluation& what) {
  const double start = omp_get_wtime();
  points_->prepare(state, box);
  const double prepared = omp_get_wtime();
  points_->evaluate(layout_.precision(), box, what, sums_);
  seconds_.search += prepared - start;
  seconds_.contacts += omp_get_wtime() - prepared;
  ContactForces::Part all;
  all.blocks.resize(layout_.blocks().size());
  std::iota(all.blocks.begin(), all.blocks.end(), 0);
  evaluate_part(all, state, box, what);
}

void ForceField::evaluate_pairs(LaneState& state, const Box& box, const Evaluation& what) {
  const double start = omp_get_wtime();
  if (bonds_.can_break()) {
    bonds_.report_broken(contacts_->list(), state, *distribution_.ranks);
  }
  contacts_->prepare(state, box, bonds_.network_of_grain());
  seconds_.search += omp_get_wtime() - start;
  if (distribution_.is_distributed()) {
    const double asked = omp_get_wtime();
    contacts_->begin_exchange();
    seconds_.halo += omp_get_wtime() - asked;
  }
  evaluate_part(contacts_->own_part(), state, box, what);
  if (distribution_.is_distributed()) {
    const double waited = omp_get_wtime();
    contacts_->end_exchange();
    seconds_.halo += omp_get_wtime() - waited;
    evaluate_part(contacts_->shared_part(), state, box, what);
  }
}

} // namespace boba
