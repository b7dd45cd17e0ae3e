// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/force_field.h"

#include "bpm/forces/image_bonds.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

namespace boba {

ForceField::ForceField(const Packing& packing, const LaneLayout& layout, const Material& material, double skin)
    : layout_(layout), material_(material), table_(kernels::best_table()), contact_list_(layout, material.diameter, skin),
      contact_sums_(layout.n_grains()) {
  results_.grains.resize(layout.n_grains());
  for (const auto& grain_template : packing.templates) {
    networks_.emplace_back(*grain_template);
    has_periodic_template_ = has_periodic_template_ || grain_template->period.has_value();
  }
  for (const Grain& grain : packing.grains) {
    network_of_grain_.push_back(&networks_[grain.template_index]);
  }
}

namespace {

/// Shift and velocity of every image in the contact list, as flat tables.
struct ImageTables {
  std::vector<double> shift, velocity;

  ImageTables(const std::vector<ImageVector>& images, const Box& box, const Matrix3& residual_rate) {
    for (const ImageVector& image : images) {
      const Vector3 n(image.a, image.b, image.c);
      const Vector3 x = box.h() * n, v = residual_rate * n;
      shift.insert(shift.end(), x.data(), x.data() + 3);
      velocity.insert(velocity.end(), v.data(), v.data() + 3);
    }
  }
};

/// Scratch of one thread, grown when needed.
struct ContactScratch {
  std::vector<double> r2;
  std::vector<std::int32_t> hit;

  void reserve(std::int64_t n) {
    if (static_cast<std::int64_t>(r2.size()) < n) {
      r2.resize(n);
      hit.resize(n);
    }
  }
};

constexpr double no_contact_r2 = 1e300;

/// Nodes whose drift and copies for the contact pass share a visit to the cache.
constexpr int drift_chunk = 128;

} // namespace

void ForceField::contacts_of(int grain, const kernels::ContactParameters& parameters, bool with_sums) {
  thread_local ContactScratch scratch;
  kernels::ContactSums& sums = contact_sums_[grain];
  sums = {};
  sums.smallest_r2 = no_contact_r2;
  const kernels::ContactRows rows = contact_list_.rows(grain);
  std::fill_n(contact_forces_.begin() + contact_list_.first_slot(grain), contact_list_.n_slots(grain),
              kernels::ContactForce{});
  scratch.reserve(rows.n + 1);
  table_.contacts(rows, contact_nodes_.data(), contact_forces_.data(), parameters, scratch.r2.data(), scratch.hit.data(),
                  with_sums, sums);
}

double ForceField::walls_on(int b, LaneState& state, std::size_t wall, double* f, bool with_sums) {
  double total = 0.0;
  for (const int grain : layout_.blocks()[b].grain) {
    if (grain >= 0) {
      total += add_wall_forces(walls_[wall], material_, layout_, grain, state, f, with_sums, contact_sums_[grain]);
    }
  }
  return total;
}

void ForceField::bonds_of(int b, LaneState& state, const Box& box, const Evaluation& what) {
  // Scratch of one thread for all blocks: it stays in the cache, and memory is not asked for forces at all.
  thread_local AlignedVector volume, force;
  const Block& block = layout_.blocks()[b];
  const NetworkData& network = networks_[block.template_index];
  const Matrix3 residual = what.residual_rate * box.h_inverse();
  const Vector3 residual_x = residual.row(0);
  const kernels::BondParameters parameters = {material_.k,
                                              material_.gamma,
                                              what.kick / material_.node_mass,
                                              what.half_kick / material_.node_mass,
                                              material_.node_mass,
                                              {residual_x[0], residual_x[1], residual_x[2]},
                                              -residual_x.dot(box.origin())};
  const auto n_lane_nodes = static_cast<std::size_t>(block.n_nodes) * block.n_lanes;
  if (block.many_body) {
    volume.assign(n_lane_nodes, 0.0);
  }
  force.assign(3 * n_lane_nodes, 0.0);
  const auto sources = contact_list_.sources(b);
  table_.scatter(sources.data(), static_cast<std::int64_t>(sources.size()), contact_forces_.data(),
                 force.data() - block.offset, block.n_lanes);
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    wall_forces_[w][b] = walls_on(b, state, w, force.data() - block.offset, what.virial != Virial::none);
  }
  kernels::BlockArrays arrays = {state.x.data() + block.offset, state.v.data() + block.offset, force.data(),
                                 volume.data(), block.alpha.data(), block.n_lanes};
  kernels::LaneSums sums;
  ImageBondSums image_sums{};
  if (!network.image_bonds().empty()) {
    image_sums = add_image_bonds(network, material_, box, what.residual_rate, block.many_body, arrays);
  }
  table_.bonds(network.view(), arrays, parameters, block.many_body, what.virial, sums);
  if (what.keep_forces) {
    std::copy(force.begin(), force.end(), state.f.begin() + block.offset);
  }
  if (what.virial == Virial::none) {
    return;
  }
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    if (block.grain[lane] < 0) {
      continue;
    }
    GrainSums& grain = results_.grains[block.grain[lane]];
    const kernels::ContactSums& contact = contact_sums_[block.grain[lane]];
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

void ForceField::collect(int b, const LaneState& state) {
  const auto sources = contact_list_.sources(b);
  table_.collect(sources.data(), static_cast<std::int64_t>(sources.size()), state.x.data(), state.v.data(),
                 layout_.blocks()[b].n_lanes, contact_nodes_.data());
}

kernels::DriftResult ForceField::drift_block(int b, LaneState& state, const kernels::Drift& drift) {
  const Block& block = layout_.blocks()[b];
  const auto sources = contact_list_.sources(b);
  auto source = sources.begin();
  kernels::DriftResult result{};
  for (int node = 0; node < block.n_nodes; node += drift_chunk) {
    const int end = std::min(node + drift_chunk, block.n_nodes);
    const std::int64_t first = block.offset + 3 * static_cast<std::int64_t>(node) * block.n_lanes;
    const std::int64_t past = block.offset + 3 * static_cast<std::int64_t>(end) * block.n_lanes;
    const kernels::DriftResult part =
        table_.drift(state.x.data() + first, state.v.data() + first, end - node, block.n_lanes, drift);
    result.largest_speed2 = std::max(result.largest_speed2, part.largest_speed2);
    result.checksum += part.checksum;
    const auto begin = source;
    while (source != sources.end() && source->from < past) {
      ++source;
    }
    table_.collect(&*begin, source - begin, state.x.data(), state.v.data(), block.n_lanes, contact_nodes_.data());
  }
  return result;
}

std::vector<kernels::DriftResult> ForceField::drift(LaneState& state, const kernels::Drift& drift) {
  const int n_blocks = static_cast<int>(layout_.blocks().size());
  std::vector<kernels::DriftResult> results(n_blocks);
#pragma omp parallel for schedule(dynamic, 1)
  for (int b = 0; b < n_blocks; ++b) {
    results[b] = drift_block(b, state, drift);
  }
  collected_ = true;
  return results;
}

/// Brings the contact list and the contact nodes up to the present state.
void ForceField::prepare_contacts(const LaneState& state, const Box& box) {
  const bool changed = contact_list_.update(state, box, network_of_grain_);
  if (collected_ && !changed) {
    return;
  }
  contact_nodes_.resize(contact_list_.slot_capacity());
  contact_forces_.resize(contact_list_.slot_capacity());
#pragma omp parallel for schedule(dynamic, 1)
  for (int b = 0; b < static_cast<int>(layout_.blocks().size()); ++b) {
    collect(b, state);
  }
}

void ForceField::evaluate(LaneState& state, const Box& box, const Evaluation& what) {
  const double start = omp_get_wtime();
  prepare_contacts(state, box);
  collected_ = false;
  const double searched = omp_get_wtime();
  const ImageTables images(contact_list_.images(), box, what.residual_rate);
  const kernels::ContactParameters contact_parameters = {material_.k,           material_.k3,        material_.gamma,
                                                         material_.diameter,    images.shift.data(), images.velocity.data()};
  const bool with_sums = what.virial != Virial::none;
  const int n_blocks = static_cast<int>(layout_.blocks().size());
  double kicked = searched;
  wall_forces_.assign(walls_.size(), std::vector<double>(n_blocks, 0.0));
#pragma omp parallel
  {
#pragma omp for schedule(dynamic, 1)
    for (int g = 0; g < layout_.n_grains(); ++g) {
      contacts_of(g, contact_parameters, with_sums);
    }
#pragma omp master
    kicked = omp_get_wtime();
#pragma omp for schedule(dynamic, 1)
    for (int b = 0; b < n_blocks; ++b) {
      bonds_of(b, state, box, what);
    }
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    walls_[w].force = 0.0;
    for (const double force : wall_forces_[w]) {
      walls_[w].force += force;
    }
  }
  if (with_sums) {
    reduce_contacts();
  }
  search_seconds += searched - start;
  contact_seconds += kicked - searched;
  bond_seconds += omp_get_wtime() - kicked;
}

void ForceField::volumes_only(const LaneState& state) const {
  AlignedVector volume;
  for (const Block& block : layout_.blocks()) {
    if (block.many_body) {
      volume.assign(static_cast<std::size_t>(block.n_nodes) * block.n_lanes, 0.0);
      table_.volumes(networks_[block.template_index].view(), state.x.data() + block.offset, volume.data(), block.n_lanes);
    }
  }
}

void ForceField::reduce_contacts() {
  results_.contacts = {};
  double smallest_r2 = no_contact_r2;
  std::int64_t sides = 0;
  for (const kernels::ContactSums& sums : contact_sums_) {
    smallest_r2 = std::min(smallest_r2, sums.smallest_r2);
    results_.contacts.energy += sums.potential;
    sides += sums.n_touching;
  }
  results_.contacts.n_touching = sides / 2;
  results_.contacts.largest_overlap = smallest_r2 < no_contact_r2 ? material_.diameter - std::sqrt(smallest_r2) : 0.0;
}

} // namespace boba
