// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/force_field.h"

#include "bpm/forces/block_pieces.h"

#include <omp.h>

namespace boba {

ForceField::ForceField(const Packing& packing, const LaneLayout& layout, const Material& material, double skin,
                       const Distribution& distribution)
    : layout_(layout), material_(material), table_(kernels::best_table()), distribution_(distribution),
      bonds_(packing, layout, material, table_), contacts_(layout, material, skin, table_, distribution),
      walls_(contacts_.law(), layout) {
  layout_changed();
}

void ForceField::layout_changed() {
  sums_.reset(layout_.n_grains());
  contacts_.layout_changed();
  bonds_.bonds_changed();
}

std::vector<BlockMotion> ForceField::drift(LaneState& state, const kernels::Drift& drift) {
  return drift_nodes(layout_, table_, state, drift, contacts_);
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
    for (int lane = 0; lane < block.n_lanes; ++lane) {
      if (const int grain = block.grain[lane]; grain >= 0) {
        field_.contacts_.add(grain, f + lane, with_sums_ ? &field_.sums_.contacts[grain] : nullptr);
      }
    }
    field_.walls_.add(block, state_, f, with_sums_, field_.sums_);
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
      contacts_.evaluate(p, box, what);
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
  const double start = omp_get_wtime();
  if (bonds_.can_break()) {
    bonds_.report_broken(contacts_.list(), state, *distribution_.ranks);
  }
  contacts_.prepare(state, box, bonds_.network_of_grain());
  seconds_.search += omp_get_wtime() - start;
  walls_.begin();
  if (distribution_.is_distributed()) {
    const double asked = omp_get_wtime();
    contacts_.begin_exchange();
    seconds_.halo += omp_get_wtime() - asked;
  }
  evaluate_part(contacts_.own_part(), state, box, what);
  if (distribution_.is_distributed()) {
    const double waited = omp_get_wtime();
    contacts_.end_exchange();
    seconds_.halo += omp_get_wtime() - waited;
    evaluate_part(contacts_.shared_part(), state, box, what);
  }
  walls_.end(distribution_);
}

} // namespace boba
