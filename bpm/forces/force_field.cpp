// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/force_field.h"

#include "bpm/forces/image_bonds.h"
#include "bpm/forces/lane_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <omp.h>
#include <stdexcept>
#include <type_traits>

namespace boba {

namespace {

/// Nodes whose drift and copies for the contact pass share a visit to the cache.
constexpr int drift_chunk = 32;

} // namespace

ForceField::ForceField(const Packing& packing, const LaneLayout& layout, const Material& material, double skin,
                       const Distribution& distribution)
    : layout_(layout), material_(material), table_(kernels::best_table()),
      contact_list_(layout, table_, material.diameter, skin, distribution), distribution_(distribution) {
  for (const auto& grain_template : packing.templates) {
    networks_.emplace_back(*grain_template);
    has_periodic_template_ = has_periodic_template_ || grain_template->period.has_value();
  }
  for (const Grain& grain : packing.grains) {
    network_of_grain_.push_back(&networks_[grain.template_index]);
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
}

template <class Coordinate, class Real>
void ForceField::add_contacts(int grain, const kernels::LaneKernels<Coordinate, Real>& lane_kernels, Real* f,
                              bool with_sums) {
  kernels::ContactSums& sums = results_.contacts[grain];
  if (with_sums) {
    sums = no_contacts;
  }
  for (const ContactSide& side : contact_list_.sides(grain)) {
    const ContactPair& pair = contact_list_.pairs()[side.pair];
    lane_kernels.add_touches(pair.touches.data(), static_cast<std::int64_t>(pair.touches.size()), side.sign, f,
                             layout_.stride(grain));
    if (with_sums && !pair.touches.empty()) {
      for (int c = 0; c < 6; ++c) {
        sums.virial[c] += 0.5 * pair.sums.virial[c];
      }
      sums.smallest_r2 = std::min(sums.smallest_r2, pair.sums.smallest_r2);
      sums.potential += 0.5 * pair.sums.potential;
      sums.n_touching += pair.sums.n_touching;
    }
  }
}

template <class Real>
void ForceField::walls_on(int b, const LaneState& state, std::size_t wall, Real* f, bool with_sums) {
  const Block& block = layout_.blocks()[b];
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    const int grain = block.grain[lane];
    if (grain >= 0) {
      const auto add = [&](int node, const Vector3& force) {
        for (int c = 0; c < 3; ++c) {
          f[(3 * static_cast<std::int64_t>(node) + c) * block.n_lanes + lane] += static_cast<Real>(force[c]);
        }
      };
      wall_forces_[wall][grain] =
          add_wall_forces(walls_[wall], material_, layout_, grain, state, add, with_sums, results_.contacts[grain]);
    }
  }
}

template <class Coordinate, class Real>
void ForceField::bonds_of(int b, LaneState& state, LaneArrays<Coordinate, Real>& lanes, const Box& box,
                          const Evaluation& what) {
  // Scratch of one thread for all blocks: it stays in the cache, and memory is not asked for forces at all.
  thread_local AlignedArray<Real> volume, force;
  const Block& block = layout_.blocks()[b];
  const NetworkData& network = networks_[block.template_index];
  const kernels::LaneKernels<Coordinate, Real>& lane_kernels = kernels_of(table_, lanes);
  const Matrix3 residual = what.residual_rate * box.h_inverse();
  const Vector3 residual_x = residual.row(0);
  const kernels::BondParameters parameters = {material_.k,
                                              material_.gamma,
                                              what.kick / material_.node_mass,
                                              what.half_kick / material_.node_mass,
                                              material_.node_mass,
                                              {residual_x[0], residual_x[1], residual_x[2]}};
  const auto n_lane_nodes = static_cast<std::size_t>(block.n_nodes) * block.n_lanes;
  if (block.many_body) {
    volume.assign(n_lane_nodes, 0);
  }
  force.assign(3 * n_lane_nodes, 0);
  double residual_shift[max_lanes] = {};
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    const int grain = block.grain[lane];
    if (grain >= 0) {
      add_contacts(grain, lane_kernels, force.data() + lane, what.virial != Virial::none);
      residual_shift[lane] = residual_x.dot(state.origin(grain) - box.origin());
    }
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    walls_on(b, state, w, force.data(), what.virial != Virial::none);
  }
  kernels::BlockArraysOf<Coordinate, Real> arrays = {lanes.x.data() + block.offset,
                                                     lanes.v.data() + block.offset,
                                                     force.data(),
                                                     volume.data(),
                                                     block.alpha.data(),
                                                     residual_shift,
                                                     state.quantum(),
                                                     block.n_lanes};
  kernels::LaneSums sums;
  ImageBondSums image_sums{};
  if constexpr (std::is_same_v<Real, double>) { // the constructor refuses them in mixed precision
    if (!network.image_bonds().empty()) {
      image_sums = add_image_bonds(network, material_, box, what.residual_rate, block.many_body, arrays);
    }
  }
  lane_kernels.bonds(network.view_as<Real>(), arrays, parameters, block.many_body, what.virial, sums);
  if (what.keep_forces) {
    std::copy(force.begin(), force.end(), lanes.f.begin() + block.offset);
  }
  if (what.virial == Virial::none) {
    return;
  }
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    if (block.grain[lane] < 0) {
      continue;
    }
    GrainSums& grain = results_.grains[block.grain[lane]];
    const kernels::ContactSums& contact = results_.contacts[block.grain[lane]];
    for (int c = 0; c < 6; ++c) {
      grain.virial[c] = sums.virial[c][lane] + contact.virial[c] + image_sums.virial[c][lane];
      grain.kinetic[c] = sums.kinetic[c][lane];
    }
    const double elsewhere = contact.virial[0] + contact.virial[1] + contact.virial[2] + image_sums.virial[0][lane] +
                             image_sums.virial[1][lane] + image_sums.virial[2][lane];
    grain.virial_trace = sums.virial[6][lane] + elsewhere;
    grain.kinetic_trace = sums.kinetic[6][lane];
  }
}

/// Tells the contact list of nodes that move far; returns the largest speed^2 of those that it does not follow.
double ForceField::note_brisk(const Block& block, std::span<const std::int32_t> nodes, const LaneState& state,
                              const kernels::Drift& drift) {
  double largest2 = 0.0;
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
      if (const double speed2 = u.squaredNorm(); speed2 > drift.brisk_speed2 && !contact_list_.note_brisk(grain, node)) {
        largest2 = std::max(largest2, speed2);
      }
    }
  }
  return largest2;
}

BlockMotion ForceField::drift_block(int b, LaneState& state, kernels::Drift drift) {
  const Block& block = layout_.blocks()[b];
  const Vector3 residual(drift.residual[0], drift.residual[1], drift.residual[2]);
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    drift.lane_shift[lane] =
        drift.residual_shift + (block.grain[lane] >= 0 ? residual.dot(state.origin(block.grain[lane])) : 0.0);
  }
  std::array<std::size_t, max_lanes> collected{};
  std::array<std::int32_t, static_cast<std::size_t>(drift_chunk) * max_lanes> brisk;
  drift.brisk = brisk.data();
  drift.brisk_speed2 = std::pow(contact_list_.brisk_motion() / drift.dt, 2);
  BlockMotion motion;
  for (int node = 0; node < block.n_nodes; node += drift_chunk) {
    const int end = std::min(node + drift_chunk, block.n_nodes);
    const std::int64_t first = block.offset + 3 * static_cast<std::int64_t>(node) * block.n_lanes;
    drift.first_node = node;
    const kernels::DriftResult part = state.visit([&](auto& lanes) {
      return kernels_of(table_, lanes)
          .drift(lanes.x.data() + first, lanes.v.data() + first, end - node, block.n_lanes, drift);
    });
    motion.largest_speed2 = std::max(motion.largest_speed2, part.largest_speed2);
    motion.common_speed2 = std::max(motion.common_speed2, std::min(part.largest_speed2, drift.brisk_speed2));
    motion.checksum += part.checksum;
    for (std::int32_t& found : std::span(brisk).first(part.n_brisk)) {
      found += node;
    }
    motion.common_speed2 =
        std::max(motion.common_speed2, note_brisk(block, std::span(brisk).first(part.n_brisk), state, drift));
    for (int lane = 0; lane < block.n_lanes; ++lane) {
      const int grain = block.grain[lane];
      if (grain >= 0) {
        const std::span<const std::int32_t> nodes = near(grain);
        const std::size_t from = collected[lane];
        while (collected[lane] < nodes.size() && nodes[collected[lane]] < end) {
          ++collected[lane];
        }
        collect(grain, nodes.subspan(from, collected[lane] - from), state);
      }
    }
  }
  return motion;
}

std::vector<BlockMotion> ForceField::drift(LaneState& state, kernels::Drift drift) {
  drift.quantum = state.quantum();
  const int n_blocks = static_cast<int>(layout_.blocks().size());
  std::vector<BlockMotion> results(n_blocks);
#pragma omp parallel for schedule(dynamic, 1)
  for (int b = 0; b < n_blocks; ++b) {
    results[b] = drift_block(b, state, drift);
  }
  collected_ = true;
  return results;
}

void ForceField::evaluate_part(const Part& part, LaneState& state, const Box& box, const Evaluation& what) {
  const double start = omp_get_wtime();
  double kicked = start;
#pragma omp parallel
  {
#pragma omp for schedule(dynamic, 4)
    for (const int p : part.pairs) {
      contacts_between(contact_list_.pairs()[p], box, what);
    }
#pragma omp master
    kicked = omp_get_wtime();
#pragma omp for schedule(dynamic, 1)
    for (const int b : part.blocks) {
      state.visit([&](auto& lanes) { bonds_of(b, state, lanes, box, what); });
    }
  }
  contact_seconds += kicked - start;
  bond_seconds += omp_get_wtime() - kicked;
}

void ForceField::evaluate(LaneState& state, const Box& box, const Evaluation& what) {
  const double start = omp_get_wtime();
  prepare_contacts(state, box);
  collected_ = false;
  search_seconds += omp_get_wtime() - start;
  wall_forces_.assign(walls_.size(), std::vector<double>(layout_.n_grains(), 0.0));
  if (distribution_.many()) {
    const double asked = omp_get_wtime();
    halo_.begin(contact_nodes_.get());
    halo_seconds += omp_get_wtime() - asked;
  }
  evaluate_part(own_part_, state, box, what);
  if (distribution_.many()) {
    const double waited = omp_get_wtime();
    halo_.end();
    halo_seconds += omp_get_wtime() - waited;
    evaluate_part(shared_part_, state, box, what);
  }
  sum_walls();
}

/// Grain by grain: the same sum for any number of threads and ranks.
void ForceField::sum_walls() {
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    distribution_.ranks->share_rows(wall_forces_[w], 1, distribution_.ownership);
    walls_[w].force = 0.0;
    for (const double force : wall_forces_[w]) {
      walls_[w].force += force;
    }
  }
}

void ForceField::share_sums(Virial virial) {
  static_assert(sizeof(GrainSums) == 14 * sizeof(double));
  if (!distribution_.many() || virial == Virial::none) {
    return;
  }
  if (virial == Virial::full) {
    distribution_.ranks->share_rows({results_.grains.front().virial.data(), 14 * results_.grains.size()}, 14,
                                    distribution_.ownership);
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
      if (block.many_body) {
        volume.assign(static_cast<std::size_t>(block.n_nodes) * block.n_lanes, 0);
        kernels_of(table_, lanes)
            .volumes(networks_[block.template_index].view_as<typename Arrays::Real>(),
                     {lanes.x.data() + block.offset, nullptr, nullptr, volume.data(), nullptr, nullptr, state.quantum(),
                      block.n_lanes});
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
  distribution_.ranks->share_rows({all.grains.front().virial.data(), 14 * all.grains.size()}, 14,
                                  distribution_.ownership);
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
  totals.largest_overlap = smallest_r2 < no_contact_r2 ? material_.diameter - std::sqrt(smallest_r2) : 0.0;
  return totals;
}

} // namespace boba
