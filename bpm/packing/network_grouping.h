// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace boba {

/// Bonded nodes as a file lists them, row by row. Views: the owner must outlive the call.
struct BondedNodes {
  Box box;                                            ///< d; bonds are measured by their nearest image in it
  std::span<const std::int64_t> id;                   ///< unique
  std::span<const std::int64_t> molecule;             ///< 0: belongs to no named molecule
  std::span<const int> type;                          ///< from 1
  std::span<const Vector3> position;                  ///< d, undeformed, wrapped or not
  std::span<const std::array<std::int64_t, 2>> bonds; ///< pairs of rows
};

/// The same nodes as a packing, and where each came from.
struct GroupedNetwork {
  /// Undeformed, at rest, alpha = 0; molecule as in the file; species = smallest type of the grain's nodes - 1.
  Packing packing;
  std::vector<std::int64_t> row; ///< per node of the packing: its row in the file
};

/// Turns bonded nodes into grains and gives grains with the identical network one template.
///
/// Grains: nodes of equal molecule, as long as these numbers can mean grains: all are positive, no bond joins two of
/// them, and there is more than one (or the network is in one piece). Otherwise every connected piece of the network is
/// a grain, numbered from 1 in order of its smallest id. The forces are the same either way.
///
/// Templates: two grains share one when their bond lists agree, node by node in order of id (or, when ids were
/// shuffled, in order of the nodes' volumes sum r0^3), with every r0 equal up to the rounding of the coordinates, 64
/// epsilon (|origin| + a + b + c). r0 is the nearest-image length in `box`. A template's nodes are sorted by
/// local_node_order and centred; its reference volume is n / 1.226 d^3.
/// A grain bonded to its own image through an upright cell becomes a periodic template of the cell's lengths.
/// \throws std::invalid_argument for a bond given twice, of length zero or as long as half the cell, for a grain bonded
/// to its own image through a tilted cell, and when there is no node.
GroupedNetwork group_network(const BondedNodes& nodes);

} // namespace boba
