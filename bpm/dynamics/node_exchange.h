// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/moving_packing.h"

#include <cstddef>
#include <vector>

namespace boba {

/// Values of nodes and grains that travel between rank 0 and the grains' owners. With one rank nothing travels.

/// This rank's nodes as they are stored, in the packing's order.
std::vector<std::byte> own_nodes(const MovingPacking& moving);

/// Rank 0's nodes, as they are stored and in the packing's order, to their owners. Collective.
void scatter_nodes(MovingPacking& moving, const std::vector<std::byte>& all);

/// Values of this rank's nodes become those of all nodes, on rank 0. Collective.
void gather_nodes(const MovingPacking& moving, std::vector<Vector3>& values);

/// Rows of `width` numbers, one for each of this rank's nodes, become those of all nodes, on rank 0. Collective.
void gather_rows(const MovingPacking& moving, int width, std::vector<double>& rows);

/// A value for each grain, known to its owner, for all ranks. Collective.
void share_grains(const MovingPacking& moving, std::vector<Vector3>& values);

} // namespace boba
