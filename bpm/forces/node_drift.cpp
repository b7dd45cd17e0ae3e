// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/node_drift.h"

#include "bpm/forces/block_pieces.h"
#include "bpm/forces/lane_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <omp.h>
#include <span>

namespace boba {

namespace {

/// Nodes whose drift and copies for the contact pass share a visit to the cache.
constexpr int drift_chunk = 32;

struct GrainNode {
  int grain;
  std::int32_t node;
};

/// What the drift of some nodes of a block saw.
struct Drifted {
  BlockMotion motion;
  std::vector<GrainNode> fast_nodes; ///< nodes that move far
};

/// Finds out which of these nodes move far; notes the largest speed^2 of those that the contact list does not follow.
void note_fast_nodes(const Block& block, std::span<const std::int32_t> nodes, const LaneState& state,
                     const kernels::Drift& drift, const ContactList& list, Drifted& drifted) {
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
        if (!list.follows(grain, node)) {
          drifted.motion.common_speed2 = std::max(drifted.motion.common_speed2, speed2);
        }
      }
    }
  }
}

void set_lane_shifts(const Block& block, const LaneState& state, kernels::Drift& drift) {
  const Vector3 residual(drift.residual[0], drift.residual[1], drift.residual[2]);
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    drift.lane_shift[lane] =
        drift.residual_shift + (block.grain[lane] >= 0 ? residual.dot(state.origin(block.grain[lane])) : 0.0);
  }
}

/// Moves the nodes [begin, end) of a block.
Drifted drift_piece(const Block& block, int begin, int end, const kernels::KernelTable& table, LaneState& state,
                    kernels::Drift drift, ContactForces& contacts) {
  set_lane_shifts(block, state, drift);
  std::array<std::size_t, max_lanes> collected{};
  for (int lane = 0; lane < block.n_lanes; ++lane) {
    if (const int grain = block.grain[lane]; grain >= 0) {
      collected[lane] = std::lower_bound(contacts.near(grain).begin(), contacts.near(grain).end(), begin) -
                        contacts.near(grain).begin();
    }
  }
  std::array<std::int32_t, static_cast<std::size_t>(drift_chunk) * max_lanes> fast;
  drift.fast = fast.data();
  drift.fast_speed2 = std::pow(contacts.list().fast_motion() / drift.dt, 2);
  Drifted drifted;
  BlockMotion& motion = drifted.motion;
  for (int node = begin; node < end; node += drift_chunk) {
    const int chunk_end = std::min(node + drift_chunk, end);
    const std::int64_t first = block.offset + 3 * static_cast<std::int64_t>(node) * block.n_lanes;
    drift.first_node = node;
    const kernels::DriftResult part = state.visit([&](auto& lanes) {
      return kernels_of(table, lanes)
          .drift(lanes.x.data() + first, lanes.v.data() + first, chunk_end - node, block.n_lanes, drift);
    });
    motion.largest_speed2 = std::max(motion.largest_speed2, part.largest_speed2);
    motion.common_speed2 = std::max(motion.common_speed2, std::min(part.largest_speed2, drift.fast_speed2));
    motion.checksum += part.checksum;
    for (std::int32_t& found : std::span(fast).first(part.n_fast)) {
      found += node;
    }
    note_fast_nodes(block, std::span(fast).first(part.n_fast), state, drift, contacts.list(), drifted);
    for (int lane = 0; lane < block.n_lanes; ++lane) {
      const int grain = block.grain[lane];
      if (grain >= 0) {
        const std::span<const std::int32_t> nodes = contacts.near(grain);
        const std::size_t from = collected[lane];
        while (collected[lane] < nodes.size() && nodes[collected[lane]] < chunk_end) {
          ++collected[lane];
        }
        contacts.collect(grain, nodes.subspan(from, collected[lane] - from), state);
      }
    }
  }
  return drifted;
}

} // namespace

std::vector<BlockMotion> drift_nodes(const LaneLayout& layout, const kernels::KernelTable& table, LaneState& state,
                                     kernels::Drift drift, ContactForces& contacts) {
  drift.quantum = state.quantum();
  const int n_blocks = static_cast<int>(layout.blocks().size());
  const int n_pieces = pieces_of(n_blocks, omp_get_max_threads());
  std::vector<Drifted> drifted(static_cast<std::size_t>(n_blocks) * n_pieces);
  // With blocks in pieces as in SplitBonds; whole blocks go to whoever is free.
  omp_set_schedule(n_pieces > 1 ? omp_sched_static : omp_sched_dynamic, 1);
#pragma omp parallel for schedule(runtime)
  for (int task = 0; task < n_blocks * n_pieces; ++task) {
    const Block& block = layout.blocks()[task / n_pieces];
    drifted[task] =
        drift_piece(block, piece_begin(block.n_nodes, n_pieces, task % n_pieces),
                    piece_begin(block.n_nodes, n_pieces, task % n_pieces + 1), table, state, drift, contacts);
  }
  std::vector<BlockMotion> results(n_blocks);
  for (int task = 0; task < n_blocks * n_pieces; ++task) {
    BlockMotion& result = results[task / n_pieces];
    const BlockMotion& motion = drifted[task].motion;
    result.largest_speed2 = std::max(result.largest_speed2, motion.largest_speed2);
    result.common_speed2 = std::max(result.common_speed2, motion.common_speed2);
    result.checksum += motion.checksum;
    for (const auto& [grain, node] : drifted[task].fast_nodes) {
      contacts.list().note_fast_node(grain, node);
    }
  }
  contacts.note_collected();
  return results;
}

std::vector<BlockMotion> drift_points(const LaneLayout& layout, const kernels::KernelTable& table, LaneState& state,
                                      const kernels::Drift& drift) {
  const int n_blocks = static_cast<int>(layout.blocks().size());
  std::vector<BlockMotion> results(n_blocks);
  state.visit([&](auto& lanes) {
    const auto& kernel = kernels_of(table, lanes);
#pragma omp parallel for schedule(static)
    for (int b = 0; b < n_blocks; ++b) {
      const Block& block = layout.blocks()[b];
      kernels::Drift of_block = drift;
      of_block.quantum = state.quantum();
      of_block.first_node = 0;
      set_lane_shifts(block, state, of_block);
      const kernels::DriftResult part = kernel.drift(lanes.x.data() + block.offset, lanes.v.data() + block.offset,
                                                     block.n_nodes, block.n_lanes, of_block);
      results[b] = {part.largest_speed2, part.largest_speed2, part.checksum};
    }
  });
  return results;
}

} // namespace boba
