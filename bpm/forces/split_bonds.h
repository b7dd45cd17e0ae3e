// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/bond_pass.h"
#include "bpm/forces/lane_kernels.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace boba {

/// Scratch of the blocks that several threads share.
template <class Real> struct SplitScratch {
  AlignedArray<Real> volume, rest_volume, force;
  std::vector<AlignedArray<Real>> beyond; ///< copies of velocities behind the end of each piece
};

/// The bonds of some blocks in pieces, several to a block. A piece comes in rounds, each of which needs all pieces of
/// the one before: volumes; forces on the piece's nodes of bonds with earlier pieces, and copies of the velocities
/// behind its end; the rest, with the kicks.
template <class Coordinate, class Real> class SplitBonds {
public:
  using Kernels = kernels::LaneKernels<Coordinate, Real>;

  /// `scratch` outlives this object and is used again by the next.
  SplitBonds(const Kernels& kernels, std::vector<BondPass<Coordinate, Real>> passes, int n_pieces,
             std::vector<SplitScratch<Real>>& scratch)
      : kernels_(kernels), n_pieces_(n_pieces), scratch_(scratch), passes_(std::move(passes)) {
    scratch.resize(std::max(scratch.size(), passes_.size()));
    for (std::size_t k = 0; k < passes_.size(); ++k) {
      const auto n_lane_nodes =
          static_cast<std::size_t>(passes_[k].block->n_nodes) * static_cast<std::size_t>(passes_[k].block->n_lanes);
      scratch[k].volume.resize(n_lane_nodes);
      scratch[k].rest_volume.resize(passes_[k].block->n_remembered > 0 ? n_lane_nodes : 0);
      scratch[k].force.resize(3 * n_lane_nodes);
      scratch[k].beyond.resize(n_pieces);
    }
    for (std::size_t k = 0; k < passes_.size(); ++k) {
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

  const Kernels& kernels_;
  int n_pieces_;
  std::vector<SplitScratch<Real>>& scratch_; ///< per block
  std::vector<BondPass<Coordinate, Real>> passes_;
};

} // namespace boba
