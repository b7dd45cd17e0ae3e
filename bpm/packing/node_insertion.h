// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/insertion.h"

namespace boba {

/// True when no grain is far from a sphere: its bounding sphere holds at most 1.3 times the sphere that has the grain's
/// radius of gyration, both with half a node diameter added. Cubes (2.3) and long ellipsoids are not.
bool are_round(const Insertion& insertion);

/// Grains at rest at random places and angles in a cubic periodic cell, no two nodes of different grains nearer than
/// `diameter`: by random sequential addition, nodes compared with nodes, so that grains of any shape come as close as
/// their surfaces allow. Where a grain finds no place, those that are in shift and turn at random by small steps
/// without overlap, and the grain tries again. The same result for the same arguments.
/// Cost: trials x nodes, most trials ending at their first few nodes.
/// Source of the method: J. Feder, "Random sequential adsorption", J. Theor. Biol. 87 (1980), 237.
/// \throws std::invalid_argument when a grain is longer than the cell; std::runtime_error when not all find a place.
Packing insert_by_nodes(const Insertion& insertion);

} // namespace boba
