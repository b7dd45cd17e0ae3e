// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

#include <vector>

namespace boba {

/// An order of nodes in which bonded nodes are near each other: entry k is the node that comes k-th.
///
/// Reverse Cuthill-McKee, so the largest |i - j| over the bonds is small: the loop over the bonds then walks through
/// memory in one window. Unbonded nodes and separate pieces are allowed.
/// Source: E. Cuthill & J. McKee, Proc. 24th ACM National Conference (1969); A. George (1971) for the reversal.
std::vector<int> local_node_order(int n_nodes, const std::vector<Bond>& bonds);

} // namespace boba
