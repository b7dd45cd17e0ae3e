// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/saved_state.h"
#include "bpm/parallel/ranks.h"

#include <array>
#include <string>

namespace boba {

/// The fields of a saved simulation that hold three numbers per node; all others are small.
inline const std::array<std::string, 3> node_fields = {"simulation.position", "simulation.velocity",
                                                       "simulation.force"};

/// Gives all ranks rank 0's fields, but for those of nodes. Collective.
void share_but_nodes(SavedState& state, const Ranks& ranks);

} // namespace boba
