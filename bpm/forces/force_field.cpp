// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/force_field.h"

#include "bpm/forces/block_pieces.h"
#include "bpm/forces/lane_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>
#include <omp.h>
#include <stdexcept>
#include <type_traits>

namespace boba {

namespace {

/// Nodes whose drift and copies for the contact pass share a visit to the cache.
constexpr int drift_chunk = 32;

/// Gives all ranks the sums of all grains, which their owners know. Collective.
void share_grain_sums(std::vector<GrainSums>& grains, const Distribution& distribution) {
  using Row = std::array<double, sizeof(GrainSums) / sizeof(double)>;
  static_assert(std::is_trivially_copyable_v<GrainSums> && sizeof(GrainSums) == sizeof(Row));
  constexpr int width = std::tuple_size_v<Row>;
  std::vector<double> rows(width * grains.size());
  for (std::size_t g = 0; g < grains.size(); ++g) {
    std::memcpy(&rows[width * g], &grains[g], sizeof(GrainSums));
  }
  distribution.ranks->share_rows(rows, width, distribution.ownership);
  for (std::size_t g = 0; g < grains.size(); ++g) {
    std::memcpy(&grains[g], &rows[width * g], sizeof(GrainSums));
  }
}

} // namespace

ForceField::ForceField(const Packing& packing, const LaneLayout& layout, const Material& material, double skin,
                       const Distribution& distribution)
    : layout_(layout), material_(material), contact_(contact_model(between_grains(material))),
      inner_contact_(material.contact_diameter ? contact_model(material) : contact_), table_(kernels::best_table()),
      contact_list_(layout, table_, {contact_->range(), inner_contact_->range()}, skin, distribution),
      distribution_(distribution) {
  for (const auto& grain_template : packing.templates) {
    networks_.emplace_back(*grain_template);
    has_periodic_template_ = has_periodic_template_ || grain_template->period.has_value();
  }
  for (const Grain& grain : packing.grains) {
    network_of_grain_.push_back(&networks_[grain.template_index]);
  }
  bonds_break_ = boba::bonds_break(packing);
  if (has_periodic_template_ && bonds_break_) {
    throw std::invalid_argument("break_strain: bonds do not break in networks that are bonded across the cell's "
                                "boundary (periodic_box)");
  }
  if (has_periodic_template_ && layout.precision() == Precision::mixed) {
    throw std::invalid_argument(
        "precision = \"mixed\" does not do networks that are bonded across the cell's boundary; "
        "allowed for them: \"double\"");
  }
  layout_changed();
}

void ForceField::layout_changed() {
  results_.grains.assign(layout_.n_grains(), {});
  results_.contacts.assign(layout_.n_grains(), no_contacts);
  std::int64_t n_nodes = 0;
  first_node_.assign(layout_.n_grains(), 0);
  for (const int grain : layout_.grains()) {
    first_node_[grain] = n_nodes;
    n_nodes += layout_.n_nodes(grain);
  }
  contact_nodes_ = std::make_unique_for_overwrite<kernels::ContactNode[]>(n_nodes);
  halo_.clear();
  contact_list_.layout_changed();
  collected_ = false;
  bonds_changed();
}

/// Finds out which of these nodes move far; notes the largest speed^2 of those that the contact list does not follow.
void ForceField::note_fast_nodes(const Block& block, std::span<const std::int32_t> nodes, const LaneState& state,
                                 const kernels::Drift& drift, Drifted& drifted) const {
  for (const std::int32_t node : nodes) {
    for (int lane = 0; lane < block.n_lanes; ++lane) {
      const int grain = block.grain[lane];
      if (grain < 0) {
        continue;
      }
      Vector3 u = state.velocity(grain, node);
      if (drift.residual[0] != 0.0 || drift.residual[1] != 0.0 || drift.residual[2] != 0.0) {
        u[0] -= Vector3(drift.residual[0], drift.residual[1], drift.residual[2]).dot(state.position(grain, node)) +
                drift.residual_shift;
      }
      if (const double speed2 = u.squaredNorm(); speed2 > drift.fast_speed2) {
        drifted.fast_nodes.push_back({grain, node});
        if (!contact_list_.follows(grain, node)) {
          drifted.motion.common_speed2 = std::max(drifted.motion.common_speed2, speed2);
        }
      }
    }
  }
}

/// Moves the nodes [begin, end) of a block.
ForceField::Drifted ForceField::drift_nodes(const Block& block, int begin, int end, LaneState& state,
                                            kernels::Drift drift) {
  const Vector3 residual(drift.residual[0], drift.residual[1], drift.residual[2]);
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    drift.lane_shift[lane] =
        drift.residual_shift + (block.grain[lane] >= 0 ? residual.dot(state.origin(block.grain[lane])) : 0.0);
  }
  std::array<std::size_t, max_lanes> collected{};
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    if (const int grain = block.grain[lane]; grain >= 0) {
      collected[lane] = std::lower_bound(near(grain).begin(), near(grain).end(), begin) - near(grain).begin();
    }
  }
  std::array<std::int32_t, static_cast<std::size_t>(drift_chunk) * max_lanes> fast;
  drift.fast = fast.data();
  drift.fast_speed2 = std::pow(contact_list_.fast_motion() / drift.dt, 2);
  Drifted drifted;
  BlockMotion& motion = drifted.motion;
  for (int node = begin; node < end; node += drift_chunk) {
    const int chunk_end = std::min(node + drift_chunk, end);
    const std::int64_t first = block.offset + 3 * static_cast<std::int64_t>(node) * block.n_lanes;
    drift.first_node = node;
    const kernels::DriftResult part = state.visit([&](auto& lanes) {
      return kernels_of(table_, lanes)
          .drift(lanes.x.data() + first, lanes.v.data() + first, chunk_end - node, block.n_lanes, drift);
    });
    motion.largest_speed2 = std::max(motion.largest_speed2, part.largest_speed2);
    motion.common_speed2 = std::max(motion.common_speed2, std::min(part.largest_speed2, drift.fast_speed2));
    motion.checksum += part.checksum;
    for (std::int32_t& found : std::span(fast).first(part.n_fast)) {
      found += node;
    }
    note_fast_nodes(block, std::span(fast).first(part.n_fast), state, drift, drifted);
    for (int lane = 0; lane < block.n_lanes; ++lane) {
      const int grain = block.grain[lane];
      if (grain >= 0) {
        const std::span<const std::int32_t> nodes = near(grain);
        const std::size_t from = collected[lane];
        while (collected[lane] < nodes.size() && nodes[collected[lane]] < chunk_end) {
          ++collected[lane];
        }
        collect(grain, nodes.subspan(from, collected[lane] - from), state);
      }
    }
  }
  return drifted;
}

std::vector<BlockMotion> ForceField::drift(LaneState& state, kernels::Drift drift) {
  drift.quantum = state.quantum();
  const int n_blocks = static_cast<int>(layout_.blocks().size());
  const int n_pieces = pieces_of(n_blocks, omp_get_max_threads());
  std::vector<Drifted> drifted(static_cast<std::size_t>(n_blocks) * n_pieces);
  // With blocks in pieces as in split_bonds_of; whole blocks go to whoever is free.
  omp_set_schedule(n_pieces > 1 ? omp_sched_static : omp_sched_dynamic, 1);
#pragma omp parallel for schedule(runtime)
  for (int task = 0; task < n_blocks * n_pieces; ++task) {
    const Block& block = layout_.blocks()[task / n_pieces];
    drifted[task] = drift_nodes(block, piece_begin(block.n_nodes, n_pieces, task % n_pieces),
                                piece_begin(block.n_nodes, n_pieces, task % n_pieces + 1), state, drift);
  }
  std::vector<BlockMotion> results(n_blocks);
  for (int task = 0; task < n_blocks * n_pieces; ++task) {
    BlockMotion& result = results[task / n_pieces];
    const BlockMotion& motion = drifted[task].motion;
    result.largest_speed2 = std::max(result.largest_speed2, motion.largest_speed2);
    result.common_speed2 = std::max(result.common_speed2, motion.common_speed2);
    result.checksum += motion.checksum;
    for (const auto& [grain, node] : drifted[task].fast_nodes) {
      contact_list_.note_fast_node(grain, node);
    }
  }
  collected_ = true;
  return results;
}

void ForceField::evaluate_part(const Part& part, LaneState& state, const Box& box, const Evaluation& what) {
  const double start = omp_get_wtime();
  double kicked = 0.0;
  const int n_pieces = pieces_of(static_cast<int>(part.blocks.size()), omp_get_max_threads());
  const bool split = n_pieces > 1 && can_split(part.blocks);
#pragma omp parallel
  {
#pragma omp for schedule(dynamic, 4)
    for (const int p : part.pairs) {
      contacts_between(contact_list_.pairs()[p], box, what);
    }
#pragma omp master
    kicked = omp_get_wtime();
    if (!split) {
#pragma omp for schedule(dynamic, 1)
      for (const int b : part.blocks) {
        state.visit([&](auto& lanes) { bonds_of(b, state, lanes, box, what); });
      }
    }
  }
  if (split) {
    state.visit([&](auto& lanes) { split_bonds_of(part.blocks, n_pieces, state, lanes, box, what); });
  }
  seconds_.contacts += kicked - start;
  seconds_.bonds += omp_get_wtime() - kicked;
}

void ForceField::evaluate(LaneState& state, const Box& box, const Evaluation& what) {
  const double start = omp_get_wtime();
  if (bonds_break_) {
    find_broken(state, !broken_are_known_);
    has_new_broken_.assign(layout_.blocks().size(), 0);
  }
  prepare_contacts(state, box);
  collected_ = false;
  seconds_.search += omp_get_wtime() - start;
  wall_forces_.assign(walls_.size(), std::vector<double>(layout_.n_grains(), 0.0));
  if (distribution_.is_distributed()) {
    const double asked = omp_get_wtime();
    halo_.begin(contact_nodes_.get());
    seconds_.halo += omp_get_wtime() - asked;
  }
  evaluate_part(own_part_, state, box, what);
  if (distribution_.is_distributed()) {
    const double waited = omp_get_wtime();
    halo_.end();
    seconds_.halo += omp_get_wtime() - waited;
    evaluate_part(shared_part_, state, box, what);
  }
  sum_walls();
}

/// Tells the contact list of the bonds that have broken: their nodes touch from now on. Collective.
void ForceField::find_broken(const LaneState& state, bool all) {
  const std::vector<Block>& blocks = layout_.blocks();
  bool found = false;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (!blocks[b].breaking.is_possible() || !(all || has_new_broken_[b] != 0)) {
      continue;
    }
    found = true;
    for (const int grain : blocks[b].grain) {
      if (grain >= 0) {
        contact_list_.set_broken(grain, broken_bonds(state, grain));
      }
    }
  }
  broken_are_known_ = true;
  if (distribution_.ranks->largest(found ? 1.0 : 0.0) > 0.0) {
    contact_list_.note_broken();
  }
}

/// Grain by grain: the same sum for any number of threads and ranks.
void ForceField::sum_walls() {
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    distribution_.ranks->share_rows(wall_forces_[w], 1, distribution_.ownership);
    walls_.set_force(w, std::accumulate(wall_forces_[w].begin(), wall_forces_[w].end(), 0.0));
  }
}

void ForceField::share_sums(Virial virial) {
  if (!distribution_.is_distributed() || virial == Virial::none) {
    return;
  }
  if (virial == Virial::full) {
    share_grain_sums(results_.grains, distribution_);
    return;
  }
  std::vector<double> traces(2 * results_.grains.size());
  for (const int g : layout_.grains()) {
    traces[2 * g] = results_.grains[g].virial_trace;
    traces[2 * g + 1] = results_.grains[g].kinetic_trace;
  }
  distribution_.ranks->share_rows(traces, 2, distribution_.ownership);
  for (std::size_t g = 0; g < results_.grains.size(); ++g) {
    results_.grains[g].virial_trace = traces[2 * g];
    results_.grains[g].kinetic_trace = traces[2 * g + 1];
  }
}

void ForceField::volumes_only(LaneState& state) const {
  state.visit([&](auto& lanes) {
    using Arrays = std::remove_reference_t<decltype(lanes)>;
    AlignedArray<typename Arrays::Real> volume;
    for (const Block& block : layout_.blocks()) {
      if (block.many_body && !block.breaking.is_possible()) {
        volume.assign(static_cast<std::size_t>(block.n_nodes) * block.n_lanes, 0);
        kernels_of(table_, lanes)
            .volumes(networks_[block.template_index].view_as<typename Arrays::Real>(),
                     {lanes.x.data() + block.offset, nullptr, nullptr, volume.data(), nullptr, nullptr, state.quantum(),
                      block.n_lanes},
                     {0, block.n_nodes, block.n_nodes});
      }
    }
  });
}

ForceField::Results ForceField::shared_results() const {
  Results all = results_;
  constexpr int width = 9;
  std::vector<double> rows;
  for (const kernels::ContactSums& sums : all.contacts) {
    rows.insert(rows.end(), sums.virial, sums.virial + 6);
    rows.insert(rows.end(), {sums.smallest_r2, sums.potential, static_cast<double>(sums.n_touching)});
  }
  distribution_.ranks->share_rows(rows, width, distribution_.ownership);
  for (std::size_t g = 0; g < all.contacts.size(); ++g) {
    const double* row = &rows[width * g];
    std::copy_n(row, 6, all.contacts[g].virial);
    all.contacts[g].smallest_r2 = row[6];
    all.contacts[g].potential = row[7];
    all.contacts[g].n_touching = static_cast<std::int64_t>(row[8]);
  }
  share_grain_sums(all.grains, distribution_);
  return all;
}

ContactTotals ForceField::contact_totals() const {
  std::vector<double> energy(layout_.n_grains());
  double smallest_r2 = no_contact_r2;
  std::int64_t sides = 0;
  for (const int g : layout_.grains()) {
    const kernels::ContactSums& sums = results_.contacts[g];
    energy[g] = sums.potential;
    sides += sums.n_touching;
    smallest_r2 = std::min(smallest_r2, sums.smallest_r2);
  }
  distribution_.ranks->share_rows(energy, 1, distribution_.ownership);
  smallest_r2 = distribution_.ranks->smallest(smallest_r2);
  ContactTotals totals;
  for (const double e : energy) { // grain by grain: the same sum for any number of threads and ranks
    totals.energy += e;
  }
  totals.n_touching = distribution_.ranks->sum(sides) / 2;
  totals.largest_overlap = smallest_r2 < no_contact_r2 ? contact_->range() - std::sqrt(smallest_r2) : 0.0;
  return totals;
}

} // namespace boba
