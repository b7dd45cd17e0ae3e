// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/bond_forces.h"

#include "bpm/forces/bond_survey.h"
#include "bpm/forces/lane_kernels.h"
#include "bpm/forces/split_bonds.h"

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace boba {

namespace {

/// Segment by segment: the same sums whatever the pieces.
void sum_up(const Block& block, std::span<const kernels::LaneSums> sums, const ImageBondSums& image_sums,
            ForceSums& totals) {
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
    GrainSums& grain = totals.grains[block.grain[lane]];
    const kernels::ContactSums& contact = totals.contacts[block.grain[lane]];
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

} // namespace

BondForces::BondForces(const Packing& packing, const LaneLayout& layout, const Material& material,
                       const kernels::KernelTable& table)
    : layout_(layout), material_(material), table_(table) {
  for (const auto& grain_template : packing.templates) {
    networks_.emplace_back(*grain_template);
    has_periodic_template_ = has_periodic_template_ || grain_template->period.has_value();
  }
  for (const Grain& grain : packing.grains) {
    network_of_grain_.push_back(&networks_[grain.template_index]);
  }
  can_break_ = bonds_break(packing);
  can_yield_ = bonds_yield(packing);
  if (has_periodic_template_ && layout.memory_slots() > 0) {
    throw std::invalid_argument("break_strain and yield_strain are not for networks that are bonded across the cell's "
                                "boundary (periodic_box)");
  }
  if (has_periodic_template_ && layout.precision() == Precision::mixed) {
    throw std::invalid_argument(
        "precision = \"mixed\" does not do networks that are bonded across the cell's boundary; "
        "allowed for them: \"double\"");
  }
}

void BondForces::report_broken(ContactList& list, const LaneState& state, const Ranks& ranks) {
  const std::vector<Block>& blocks = layout_.blocks();
  const bool all = !broken_are_known_;
  bool found = false;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (!blocks[b].breaking.is_possible() || !(all || has_new_broken_[b] != 0)) {
      continue;
    }
    found = true;
    for (const int grain : blocks[b].grain) {
      if (grain >= 0) {
        list.set_broken(grain, broken_bonds(*network_of_grain_[grain], layout_, state, grain));
      }
    }
  }
  broken_are_known_ = true;
  if (ranks.largest(found ? 1.0 : 0.0) > 0.0) {
    list.note_broken();
  }
  has_new_broken_.assign(blocks.size(), 0);
}

void BondForces::note_broken(int b, std::span<const kernels::LaneSums> sums) {
  if (layout_.blocks()[b].breaking.is_possible()) {
    has_new_broken_[b] =
        std::any_of(sums.begin(), sums.end(), [](const kernels::LaneSums& s) { return s.n_broken > 0; });
  }
}

bool BondForces::can_split(const std::vector<int>& blocks) const {
  return std::all_of(blocks.begin(), blocks.end(), [&](int b) {
    const Block& block = layout_.blocks()[b];
    return segments_of(block.n_nodes) == most_pieces && networks_[block.template_index].image_bonds().empty();
  });
}

template <class Coordinate, class Real>
BondPass<Coordinate, Real> BondForces::pass_of(int b, LaneArrays<Coordinate, Real>& lanes,
                                               const BondEvaluation& evaluation) const {
  const Block& block = layout_.blocks()[b];
  return {block, networks_[block.template_index], material_, evaluation.state, lanes, evaluation.box, evaluation.what};
}

template <class Coordinate, class Real>
void BondForces::evaluate_block(int b, LaneArrays<Coordinate, Real>& lanes, const BondEvaluation& evaluation) {
  // Scratch of one thread for all blocks: it stays in the cache, and memory is not asked for forces at all. Zero but in
  // here.
  thread_local AlignedArray<Real> volume, rest_volume, force;
  const Evaluation& what = evaluation.what;
  BondPass<Coordinate, Real> pass = pass_of(b, lanes, evaluation);
  const Block& block = *pass.block;
  const auto n_lane_nodes = static_cast<std::size_t>(block.n_nodes) * block.n_lanes;
  if (block.many_body && volume.size() < n_lane_nodes) {
    volume.resize(n_lane_nodes, 0);
  }
  if (block.many_body && block.n_remembered > 0 && rest_volume.size() < n_lane_nodes) {
    rest_volume.resize(n_lane_nodes, 0);
  }
  if (force.size() < 3 * n_lane_nodes) {
    force.resize(3 * n_lane_nodes, 0);
  }
  evaluation.others.add(b, force.data());
  pass.arrays.f = force.data();
  pass.arrays.volume = volume.data();
  pass.arrays.rest_volume = rest_volume.data();
  pass.arrays.residual_shift = pass.residual_shift.data();
  pass.arrays.leaves_zeros = !what.keep_forces;
  ImageBondSums image_sums{};
  if constexpr (std::is_same_v<Real, double>) { // the constructor refuses them in mixed precision
    if (!pass.network->image_bonds().empty()) {
      image_sums = add_image_bonds(*pass.network, bond_law(material_), evaluation.box, what.residual_rate,
                                   block.many_body, pass.arrays);
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
    sum_up(block, pass.sums, image_sums, evaluation.sums);
  }
  note_broken(b, pass.sums);
}

template <class Coordinate, class Real>
void BondForces::evaluate_pieces(const std::vector<int>& blocks, int n_pieces, LaneArrays<Coordinate, Real>& lanes,
                                 const BondEvaluation& evaluation) {
  const Evaluation& what = evaluation.what;
  std::vector<BondPass<Coordinate, Real>> passes;
  for (const int b : blocks) {
    passes.push_back(pass_of(b, lanes, evaluation));
  }
  thread_local std::vector<SplitScratch<Real>> scratch_of_caller;
  std::vector<SplitScratch<Real>>& scratch = scratch_of_caller; // of the calling thread, used by all
  SplitBonds<Coordinate, Real> bonds(kernels_of(table_, lanes), std::move(passes), n_pieces, scratch);
  const int n_blocks = static_cast<int>(blocks.size());
#pragma omp parallel
  {
#pragma omp for schedule(dynamic, 1) nowait
    for (int k = 0; k < n_blocks; ++k) {
      std::fill(scratch[k].force.begin(), scratch[k].force.end(), Real{0});
      evaluation.others.add(blocks[k], scratch[k].force.data());
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
      sum_up(*bonds.pass(k).block, bonds.pass(k).sums, {}, evaluation.sums);
    }
    note_broken(blocks[k], bonds.pass(k).sums);
  }
}

void BondForces::evaluate(int block, const BondEvaluation& evaluation) {
  evaluation.state.visit([&](auto& lanes) { evaluate_block(block, lanes, evaluation); });
}

void BondForces::evaluate_split(const std::vector<int>& blocks, int n_pieces, const BondEvaluation& evaluation) {
  evaluation.state.visit([&](auto& lanes) { evaluate_pieces(blocks, n_pieces, lanes, evaluation); });
}

void BondForces::volumes_only(LaneState& state) const {
  state.visit([&](auto& lanes) {
    using Arrays = std::remove_reference_t<decltype(lanes)>;
    AlignedArray<typename Arrays::Real> volume;
    for (const Block& block : layout_.blocks()) {
      if (block.many_body && block.n_remembered == 0) {
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

} // namespace boba
