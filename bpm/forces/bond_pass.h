// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/block_pieces.h"
#include "bpm/forces/evaluation.h"
#include "bpm/forces/network_data.h"
#include "bpm/laws/material.h"
#include "bpm/packing/lane_state.h"

#include <array>
#include <cstdint>
#include <vector>

namespace boba {

/// What the passes over a block's bonds share; arrays.f holds contacts and walls before the bonds come.
template <class Coordinate, class Real> struct BondPass {
  const Block* block;
  const NetworkData* network;
  kernels::BlockArraysOf<Coordinate, Real> arrays;
  std::array<double, max_lanes> residual_shift{};
  kernels::BondParameters parameters;
  kernels::BondParametersOf<BreakingBondLaw> breaking{}; ///< the same for blocks whose bonds break
  std::vector<kernels::LaneSums> sums;                   ///< of each segment

  using Kernels = kernels::LaneKernels<Coordinate, Real>;

  /// Of a block with its network. The scratch arrays (f, volume, rest_volume) are the caller's to set.
  BondPass(const Block& of_block, const NetworkData& of_network, const Material& material, LaneState& state,
           LaneArrays<Coordinate, Real>& lanes, const Box& box, const Evaluation& what);

  void volumes(const Kernels& kernels, const kernels::NodeRange& range) const;
  void bonds_from_before(const Kernels& kernels, const kernels::NodeRange& range) const;
  /// With these arrays, which are those of the pass but for what a piece has of its own.
  void bonds(const Kernels& kernels, const kernels::BlockArraysOf<Coordinate, Real>& with, Virial virial,
             const kernels::NodeRange& range, std::int64_t& volumes_done, kernels::LaneSums& sums_of_range) const;
};

template <class Coordinate, class Real>
BondPass<Coordinate, Real>::BondPass(const Block& of_block, const NetworkData& of_network, const Material& material,
                                     LaneState& state, LaneArrays<Coordinate, Real>& lanes, const Box& box,
                                     const Evaluation& what)
    : block(&of_block), network(&of_network), arrays{lanes.x.data() + of_block.offset,
                                                     lanes.v.data() + of_block.offset,
                                                     nullptr,
                                                     nullptr,
                                                     of_block.alpha.data(),
                                                     nullptr,
                                                     state.quantum(),
                                                     of_block.n_lanes},
      sums(segments_of(of_block.n_nodes)) {
  const Vector3 residual = (what.residual_rate * box.h_inverse()).row(0);
  parameters = {bond_law(material),
                what.kick / material.node_mass,
                what.half_kick / material.node_mass,
                material.node_mass,
                {residual[0], residual[1], residual[2]}};
  if (block->breaking.is_possible()) {
    const kernels::BondParameters& p = parameters;
    breaking = {{p.law, block->breaking.in_tension_only, block->breaking.smooth},
                p.kick,
                p.half_kick,
                p.mass,
                {p.residual[0], p.residual[1], p.residual[2]}};
    arrays.memory = lanes.memory.data() + block->memory;
    arrays.keeps_memory = !what.is_trial;
  }
  for (int lane = 0; lane < block->n_lanes; ++lane) {
    if (block->grain[lane] >= 0) {
      residual_shift[lane] = residual.dot(state.origin(block->grain[lane]) - box.origin());
    }
  }
}

template <class Coordinate, class Real>
void BondPass<Coordinate, Real>::volumes(const Kernels& kernels, const kernels::NodeRange& range) const {
  (block->breaking.is_possible() ? kernels.breaking.volumes : kernels.volumes)(network->template view_as<Real>(),
                                                                               arrays, range);
}

template <class Coordinate, class Real>
void BondPass<Coordinate, Real>::bonds_from_before(const Kernels& kernels, const kernels::NodeRange& range) const {
  const auto view = network->template view_as<Real>();
  if (block->breaking.is_possible()) {
    kernels.breaking.bonds_from_before(view, arrays, breaking, block->many_body, range);
  } else {
    kernels.bonds_from_before(view, arrays, parameters, block->many_body, range);
  }
}

template <class Coordinate, class Real>
void BondPass<Coordinate, Real>::bonds(const Kernels& kernels, const kernels::BlockArraysOf<Coordinate, Real>& with,
                                       Virial virial, const kernels::NodeRange& range, std::int64_t& volumes_done,
                                       kernels::LaneSums& sums_of_range) const {
  const auto view = network->template view_as<Real>();
  if (block->breaking.is_possible()) {
    kernels.breaking.bonds(view, with, breaking, block->many_body, virial, range, volumes_done, sums_of_range);
  } else {
    kernels.bonds(view, with, parameters, block->many_body, virial, range, volumes_done, sums_of_range);
  }
}

} // namespace boba
