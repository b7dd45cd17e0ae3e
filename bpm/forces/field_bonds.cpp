// SPDX-License-Identifier: GPL-3.0-or-later
// How a force field goes through the bonds of its blocks, once contacts and walls have been added: a block by one
// thread, or, where there are fewer blocks than threads want, in pieces by several. The forces are the same to the last
// bit.
#include "bpm/forces/block_pieces.h"
#include "bpm/forces/force_field.h"
#include "bpm/forces/image_bonds.h"
#include "bpm/forces/lane_kernels.h"

#include <algorithm>
#include <type_traits>

namespace boba {

template <class Coordinate, class Real>
void ForceField::add_contacts(int grain, const kernels::LaneKernels<Coordinate, Real>& lane_kernels, Real* f,
                              bool with_sums) {
  kernels::ContactSums& sums = results_.contacts[grain];
  if (with_sums) {
    sums = no_contacts;
  }
  for (const ContactSide& side : contact_list_.near_sides(grain)) {
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
          add_wall_forces(walls_[wall], *contact_, layout_, grain, state, add, with_sums, results_.contacts[grain]);
    }
  }
}

/// Contacts and walls of a block's grains, into forces that are zero.
template <class Coordinate, class Real>
void ForceField::add_others(int b, const LaneState& state, const LaneArrays<Coordinate, Real>& lanes, Real* f,
                            const Evaluation& what) {
  const Block& block = layout_.blocks()[b];
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    if (block.grain[lane] >= 0) {
      add_contacts(block.grain[lane], kernels_of(table_, lanes), f + lane, what.virial != Virial::none);
    }
  }
  for (std::size_t w = 0; w < walls_.size(); ++w) {
    walls_on(b, state, w, f, what.virial != Virial::none);
  }
}

template <class Coordinate, class Real>
void ForceField::BondPass<Coordinate, Real>::volumes(const Kernels& kernels, const kernels::NodeRange& range) const {
  (block->breaking.is_possible() ? kernels.breaking.volumes : kernels.volumes)(network->template view_as<Real>(),
                                                                               arrays, range);
}

template <class Coordinate, class Real>
void ForceField::BondPass<Coordinate, Real>::bonds_from_before(const Kernels& kernels,
                                                               const kernels::NodeRange& range) const {
  const auto view = network->template view_as<Real>();
  if (block->breaking.is_possible()) {
    kernels.breaking.bonds_from_before(view, arrays, breaking, block->many_body, range);
  } else {
    kernels.bonds_from_before(view, arrays, parameters, block->many_body, range);
  }
}

template <class Coordinate, class Real>
void ForceField::BondPass<Coordinate, Real>::bonds(const Kernels& kernels,
                                                   const kernels::BlockArraysOf<Coordinate, Real>& with, Virial virial,
                                                   const kernels::NodeRange& range, std::int64_t& volumes_done,
                                                   kernels::LaneSums& sums_of_range) const {
  const auto view = network->template view_as<Real>();
  if (block->breaking.is_possible()) {
    kernels.breaking.bonds(view, with, breaking, block->many_body, virial, range, volumes_done, sums_of_range);
  } else {
    kernels.bonds(view, with, parameters, block->many_body, virial, range, volumes_done, sums_of_range);
  }
}

template <class Coordinate, class Real>
ForceField::BondPass<Coordinate, Real> ForceField::bond_pass(int b, LaneState& state,
                                                             LaneArrays<Coordinate, Real>& lanes, const Box& box,
                                                             const Evaluation& what) const {
  const Block& block = layout_.blocks()[b];
  const Vector3 residual = (what.residual_rate * box.h_inverse()).row(0);
  BondPass<Coordinate, Real> pass{&block,
                                  &networks_[block.template_index],
                                  {lanes.x.data() + block.offset, lanes.v.data() + block.offset, nullptr, nullptr,
                                   block.alpha.data(), nullptr, state.quantum(), block.n_lanes},
                                  {},
                                  {bond_law(material_),
                                   what.kick / material_.node_mass,
                                   what.half_kick / material_.node_mass,
                                   material_.node_mass,
                                   {residual[0], residual[1], residual[2]}},
                                  {},
                                  std::vector<kernels::LaneSums>(segments_of(block.n_nodes))};
  if (block.breaking.is_possible()) {
    const kernels::BondParameters& p = pass.parameters;
    pass.breaking = {{p.law, block.breaking.in_tension_only, block.breaking.smooth},
                     p.kick,
                     p.half_kick,
                     p.mass,
                     {p.residual[0], p.residual[1], p.residual[2]}};
    pass.arrays.memory = lanes.memory.data() + block.memory;
    pass.arrays.keeps_memory = !what.is_trial;
  }
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    if (block.grain[lane] >= 0) {
      pass.residual_shift[lane] = residual.dot(state.origin(block.grain[lane]) - box.origin());
    }
  }
  return pass;
}

template <class Coordinate, class Real>
void ForceField::bonds_of(int b, LaneState& state, LaneArrays<Coordinate, Real>& lanes, const Box& box,
                          const Evaluation& what) {
  // Scratch of one thread for all blocks: it stays in the cache, and memory is not asked for forces at all. Zero but in
  // here.
  thread_local AlignedArray<Real> volume, rest_volume, force;
  BondPass<Coordinate, Real> pass = bond_pass(b, state, lanes, box, what);
  const Block& block = *pass.block;
  const auto n_lane_nodes = static_cast<std::size_t>(block.n_nodes) * block.n_lanes;
  if (block.many_body && volume.size() < n_lane_nodes) {
    volume.resize(n_lane_nodes, 0);
  }
  if (block.many_body && block.breaking.is_possible() && rest_volume.size() < n_lane_nodes) {
    rest_volume.resize(n_lane_nodes, 0);
  }
  if (force.size() < 3 * n_lane_nodes) {
    force.resize(3 * n_lane_nodes, 0);
  }
  add_others(b, state, lanes, force.data(), what);
  pass.arrays.f = force.data();
  pass.arrays.volume = volume.data();
  pass.arrays.rest_volume = rest_volume.data();
  pass.arrays.residual_shift = pass.residual_shift.data();
  pass.arrays.leaves_zeros = !what.keep_forces;
  ImageBondSums image_sums{};
  if constexpr (std::is_same_v<Real, double>) { // the constructor refuses them in mixed precision
    if (!pass.network->image_bonds().empty()) {
      image_sums =
          add_image_bonds(*pass.network, bond_law(material_), box, what.residual_rate, block.many_body, pass.arrays);
    }
  }
  std::int64_t volumes_done = 0;
  const int n_segments = segments_of(block.n_nodes);
  for (int s = 0; s < n_segments; ++s) {
    pass.bonds(
        kernels_of(table_, lanes), pass.arrays, what.virial,
        {piece_begin(block.n_nodes, n_segments, s), piece_begin(block.n_nodes, n_segments, s + 1), block.n_nodes},
        volumes_done, pass.sums[s]);
  }
  if (what.keep_forces) {
    const auto forces = std::span(force).first(3 * n_lane_nodes);
    std::copy(forces.begin(), forces.end(), lanes.f.begin() + block.offset);
    std::fill(forces.begin(), forces.end(), Real{0});
    std::fill(volume.begin(), volume.end(), Real{0});
    std::fill(rest_volume.begin(), rest_volume.end(), Real{0});
  }
  if (what.virial != Virial::none) {
    sum_up(block, pass.sums, image_sums);
  }
  note_broken(b, pass.sums);
}

void ForceField::note_broken(int b, std::span<const kernels::LaneSums> sums) {
  if (layout_.blocks()[b].breaking.is_possible()) {
    has_new_broken_[b] =
        std::any_of(sums.begin(), sums.end(), [](const kernels::LaneSums& s) { return s.n_broken > 0; });
  }
}

bool ForceField::can_split(const std::vector<int>& blocks) const {
  return std::all_of(blocks.begin(), blocks.end(), [&](int b) {
    const Block& block = layout_.blocks()[b];
    return segments_of(block.n_nodes) == most_pieces && networks_[block.template_index].image_bonds().empty();
  });
}

/// Scratch of the blocks that several threads share.
template <class Real> struct SplitScratch {
  AlignedArray<Real> volume, rest_volume, force;
  std::vector<AlignedArray<Real>> beyond; ///< copies of velocities behind the end of each piece
};

/// The bonds of some blocks in pieces, several to a block. A piece comes in rounds, each of which needs all pieces of
/// the one before: volumes; forces on the piece's nodes of bonds with earlier pieces, and copies of the velocities
/// behind its end; the rest, with the kicks.
template <class Coordinate, class Real> class ForceField::SplitBonds {
public:
  SplitBonds(const ForceField& field, const std::vector<int>& blocks, int n_pieces, LaneState& state,
             LaneArrays<Coordinate, Real>& lanes, const Box& box, const Evaluation& what,
             std::vector<SplitScratch<Real>>& scratch)
      : kernels_(kernels_of(field.table_, lanes)), n_pieces_(n_pieces), scratch_(scratch) {
    scratch.resize(std::max(scratch.size(), blocks.size()));
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      passes_.push_back(field.bond_pass(blocks[k], state, lanes, box, what));
      const auto n_lane_nodes =
          static_cast<std::size_t>(passes_[k].block->n_nodes) * static_cast<std::size_t>(passes_[k].block->n_lanes);
      scratch[k].volume.resize(n_lane_nodes);
      scratch[k].rest_volume.resize(passes_[k].block->breaking.is_possible() ? n_lane_nodes : 0);
      scratch[k].force.resize(3 * n_lane_nodes);
      scratch[k].beyond.resize(n_pieces);
    }
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      passes_[k].arrays.f = scratch[k].force.data();
      passes_[k].arrays.volume = scratch[k].volume.data();
      passes_[k].arrays.rest_volume = scratch[k].rest_volume.data();
      passes_[k].arrays.residual_shift = passes_[k].residual_shift.data();
    }
  }

  void volumes(int task) {
    const int k = task / n_pieces_;
    const Block& block = *passes_[k].block;
    if (block.many_body) {
      const kernels::NodeRange range = range_of(task);
      for (AlignedArray<Real>* volume : {&scratch_[k].volume, &scratch_[k].rest_volume}) {
        if (!volume->empty()) {
          std::fill(volume->begin() + static_cast<std::ptrdiff_t>(range.begin) * block.n_lanes,
                    volume->begin() + static_cast<std::ptrdiff_t>(range.end) * block.n_lanes, Real{0});
        }
      }
      passes_[k].volumes(kernels_, range);
    }
  }

  void bonds_from_before(int task) {
    const int k = task / n_pieces_, piece = task % n_pieces_;
    const Block& block = *passes_[k].block;
    const kernels::NodeRange range = range_of(task);
    const auto network = passes_[k].network->template view_as<Real>();
    passes_[k].bonds_from_before(kernels_, range);
    const std::int64_t width = 3 * static_cast<std::int64_t>(block.n_lanes);
    const Real* v = passes_[k].arrays.v;
    scratch_[k].beyond[piece].assign(v + width * range.end, v + width * network.reach[range.end - 1]);
  }

  void rest(int task, Virial virial) {
    const int k = task / n_pieces_, piece = task % n_pieces_;
    const Block& block = *passes_[k].block;
    auto arrays = passes_[k].arrays;
    arrays.v_beyond = scratch_[k].beyond[piece].data();
    std::int64_t volumes_done = block.n_nodes;
    for (int s = piece * most_pieces / n_pieces_; s < (piece + 1) * most_pieces / n_pieces_; ++s) {
      passes_[k].bonds(kernels_, arrays, virial,
                       {piece_begin(block.n_nodes, most_pieces, s), piece_begin(block.n_nodes, most_pieces, s + 1),
                        piece_begin(block.n_nodes, n_pieces_, piece + 1)},
                       volumes_done, passes_[k].sums[s]);
    }
  }

  const BondPass<Coordinate, Real>& pass(int k) const { return passes_[k]; }

private:
  kernels::NodeRange range_of(int task) const {
    const int n_nodes = passes_[task / n_pieces_].block->n_nodes, piece = task % n_pieces_;
    const int end = piece_begin(n_nodes, n_pieces_, piece + 1);
    return {piece_begin(n_nodes, n_pieces_, piece), end, end};
  }

  const kernels::LaneKernels<Coordinate, Real>& kernels_;
  int n_pieces_;
  std::vector<SplitScratch<Real>>& scratch_; ///< per block
  std::vector<BondPass<Coordinate, Real>> passes_;
};

template <class Coordinate, class Real>
void ForceField::split_bonds_of(const std::vector<int>& blocks, int n_pieces, LaneState& state,
                                LaneArrays<Coordinate, Real>& lanes, const Box& box, const Evaluation& what) {
  thread_local std::vector<SplitScratch<Real>> scratch_of_caller;
  std::vector<SplitScratch<Real>>& scratch = scratch_of_caller; // of the calling thread, used by all
  SplitBonds<Coordinate, Real> bonds(*this, blocks, n_pieces, state, lanes, box, what, scratch);
  const int n_blocks = static_cast<int>(blocks.size());
#pragma omp parallel
  {
#pragma omp for schedule(dynamic, 1) nowait
    for (int k = 0; k < n_blocks; ++k) {
      std::fill(scratch[k].force.begin(), scratch[k].force.end(), Real{0});
      add_others(blocks[k], state, lanes, scratch[k].force.data(), what);
    }
    // A thread has the same pieces in all rounds and in the drift: they stay in its cache.
#pragma omp for schedule(static, 1)
    for (int task = 0; task < n_blocks * n_pieces; ++task) {
      bonds.volumes(task);
    }
#pragma omp for schedule(static, 1)
    for (int task = 0; task < n_blocks * n_pieces; ++task) {
      bonds.bonds_from_before(task);
    }
#pragma omp for schedule(static, 1)
    for (int task = 0; task < n_blocks * n_pieces; ++task) {
      bonds.rest(task, what.virial);
    }
  }
  for (int k = 0; k < n_blocks; ++k) {
    if (what.keep_forces) {
      std::copy(scratch[k].force.begin(), scratch[k].force.end(), lanes.f.begin() + bonds.pass(k).block->offset);
    }
    if (what.virial != Virial::none) {
      sum_up(*bonds.pass(k).block, bonds.pass(k).sums, {});
    }
    note_broken(blocks[k], bonds.pass(k).sums);
  }
}

/// Segment by segment: the same sums whatever the pieces.
void ForceField::sum_up(const Block& block, std::span<const kernels::LaneSums> sums, const ImageBondSums& image_sums) {
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    if (block.grain[lane] < 0) {
      continue;
    }
    double virial[7] = {}, kinetic[7] = {};
    for (const kernels::LaneSums& of_segment : sums) {
      for (int c = 0; c < 7; ++c) {
        virial[c] += of_segment.virial[c][lane];
        kinetic[c] += of_segment.kinetic[c][lane];
      }
    }
    GrainSums& grain = results_.grains[block.grain[lane]];
    const kernels::ContactSums& contact = results_.contacts[block.grain[lane]];
    double elsewhere = 0.0;
    for (int c = 0; c < 6; ++c) {
      grain.virial[c] = virial[c] + contact.virial[c] + image_sums.virial[c][lane];
      grain.kinetic[c] = kinetic[c];
      elsewhere += c < 3 ? contact.virial[c] + image_sums.virial[c][lane] : 0.0;
    }
    grain.virial_trace = virial[6] + elsewhere;
    grain.kinetic_trace = kinetic[6];
  }
}

template void ForceField::bonds_of(int, LaneState&, LaneArrays<double, double>&, const Box&, const Evaluation&);
template void ForceField::bonds_of(int, LaneState&, LaneArrays<std::int32_t, float>&, const Box&, const Evaluation&);
template void ForceField::split_bonds_of(const std::vector<int>&, int, LaneState&, LaneArrays<double, double>&,
                                         const Box&, const Evaluation&);
template void ForceField::split_bonds_of(const std::vector<int>&, int, LaneState&, LaneArrays<std::int32_t, float>&,
                                         const Box&, const Evaluation&);

} // namespace boba
