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
  kernels::BondParametersOf<YieldingBondLaw> yielding{}; ///< and for those whose bonds yield
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

private:
  /// Calls visit(kernels, parameters) with those of the block's law.
  template <class Visit> void with_law(const Kernels& kernels, Visit&& visit) const {
    if (block->yielding.is_possible()) {
      visit(kernels.yielding, yielding);
    } else if (block->breaking.is_possible()) {
      visit(kernels.breaking, breaking);
    } else {
      visit(kernels, parameters);
    }
  }
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
  if (block->n_remembered > 0) {
    const kernels::BondParameters& p = parameters;
    const auto with = [&]<class Law>(const Law& law) {
      return kernels::BondParametersOf<Law>{
          law, p.kick, p.half_kick, p.mass, {p.residual[0], p.residual[1], p.residual[2]}};
    };
    const BreakingBondLaw breaking_law = {p.law, block->breaking.in_tension_only, block->breaking.smooth};
    breaking = with(breaking_law);
    yielding = with(YieldingBondLaw{breaking_law, block->yielding.strain, block->yielding.hardening});
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
  with_law(kernels,
           [&](const auto& of_law, const auto&) { of_law.volumes(network->template view_as<Real>(), arrays, range); });
}

template <class Coordinate, class Real>
void BondPass<Coordinate, Real>::bonds_from_before(const Kernels& kernels, const kernels::NodeRange& range) const {
  with_law(kernels, [&](const auto& of_law, const auto& p) {
    of_law.bonds_from_before(network->template view_as<Real>(), arrays, p, block->many_body, range);
  });
}

template <class Coordinate, class Real>
void BondPass<Coordinate, Real>::bonds(const Kernels& kernels, const kernels::BlockArraysOf<Coordinate, Real>& with,
                                       Virial virial, const kernels::NodeRange& range, std::int64_t& volumes_done,
                                       kernels::LaneSums& sums_of_range) const {
  with_law(kernels, [&](const auto& of_law, const auto& p) {
    of_law.bonds(network->template view_as<Real>(), with, p, block->many_body, virial, range, volumes_done,
                 sums_of_range);
  });
}

} // namespace boba
