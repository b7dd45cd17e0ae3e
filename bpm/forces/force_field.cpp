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

} // namespace

void ForceField::contacts_of(int grain, LaneState& state, const kernels::ContactParameters& parameters, bool with_sums) {
  thread_local ContactScratch scratch;
  kernels::ContactSums& sums = contact_sums_[grain];
  sums = {};
  sums.smallest_r2 = no_contact_r2;
  for (const int stride : {block_lanes, 1}) {
    const kernels::ContactRows rows = contact_list_.rows(grain, stride);
    if (rows.n > 0) {
      scratch.reserve(rows.n + 1);
      table_.contacts(rows, layout_.first(grain), state.x.data(), state.v.data(), state.f.data() + layout_.first(grain),
                      parameters, scratch.r2.data(), scratch.hit.data(), with_sums, sums);
    }
  }
}

void ForceField::bonds_of(const Block& block, LaneState& state, const Box& box, const Evaluation& what) {
  thread_local AlignedVector volume;
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
  if (block.many_body) {
    volume.assign(static_cast<std::size_t>(block.n_nodes) * block.n_lanes, 0.0);
  }
  kernels::BlockArrays arrays = {state.x.data() + block.offset, state.v.data() + block.offset,
                                 state.f.data() + block.offset, volume.data(), block.alpha.data(), block.n_lanes};
  kernels::LaneSums sums;
  ImageBondSums image_sums{};
  if (!network.image_bonds().empty()) {
    image_sums = add_image_bonds(network, material_, box, what.residual_rate, block.many_body, arrays);
  }
  table_.bonds(network.view(), arrays, parameters, block.many_body, what.virial, sums);
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

void ForceField::evaluate(LaneState& state, const Box& box, const Evaluation& what) {
  const double start = omp_get_wtime();
  contact_list_.update(state, box, network_of_grain_);
  const double searched = omp_get_wtime();
  const ImageTables images(contact_list_.images(), box, what.residual_rate);
  const kernels::ContactParameters contact_parameters = {material_.k,           material_.k3,        material_.gamma,
                                                         material_.diameter,    images.shift.data(), images.velocity.data()};
  const bool with_sums = what.virial != Virial::none;
  const std::vector<Block>& blocks = layout_.blocks();
  double kicked = searched;
  std::vector<std::vector<double>> wall_forces(walls_.size(), std::vector<double>(layout_.n_grains(), 0.0));
#pragma omp parallel
  {
#pragma omp for schedule(dynamic, 1)
    for (int b = 0; b < static_cast<int>(blocks.size()); ++b) {
      const Block& block = blocks[b];
      std::fill_n(state.f.begin() + block.offset, 3 * static_cast<std::int64_t>(block.n_nodes) * block.n_lanes, 0.0);
      for (const int grain : block.grain) {
        if (grain >= 0) {
          contacts_of(grain, state, contact_parameters, with_sums);
          for (std::size_t w = 0; w < walls_.size(); ++w) {
            wall_forces[w][grain] =
                add_wall_forces(walls_[w], material_, layout_, grain, state, with_sums, contact_sums_[grain]);
          }
        }
      }
    }
    // Contacts read the velocities of other grains, bonds change them: all contacts come first.
#pragma omp master
    kicked = omp_get_wtime();
#pragma omp for schedule(dynamic, 1)
    for (int b = 0; b < static_cast<int>(blocks.size()); ++b) {
      bonds_of(blocks[b], state, box, what);
    }
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    walls_[w].force = 0.0;
    for (const double force : wall_forces[w]) {
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
