// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace boba {

// A block's nodes in ranges of about the same length. Sums over a block are taken segment by segment whoever does it,
// so that its last bits do not depend on how many threads shared the block.

/// Most pieces that a block is split into, and segments of a block that can be split.
inline constexpr int most_pieces = 4;
/// Nodes per grain from which a block can be split: pieces of fewer have mostly bonds with each other.
inline constexpr int least_nodes_to_split = 1000;

inline int segments_of(int n_nodes) {
  return n_nodes < least_nodes_to_split ? 1 : most_pieces;
}

/// First node of one of n pieces; n_nodes for piece n.
inline int piece_begin(int n_nodes, int n, int piece) {
  return static_cast<int>(static_cast<std::int64_t>(n_nodes) * piece / n);
}

/// Pieces of each of n blocks for so many threads: one where the blocks go round evenly or are many.
inline int pieces_of(int n_blocks, int n_threads) {
  if (n_threads == 1 || n_blocks % n_threads == 0 || n_blocks > 4 * n_threads) {
    return 1;
  }
  return 2 * n_blocks >= n_threads ? 2 : most_pieces;
}

} // namespace boba
