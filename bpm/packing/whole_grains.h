// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"

#include <span>
#include <vector>

namespace boba {

/// Moves nodes by lattice vectors so that every grain is in one piece: x_i + h n_i with integer n_i (d).
///
/// Walks each grain's bonds and takes the nearest image of every next node; the first node of a grain stays where it
/// is. Further pieces that no bond joins go to the image nearest to the first piece's mean. The result does not depend
/// on how `position` (by node number of the packing) was wrapped. In a grain of a periodic template bonds may still
/// pass through the boundary. \throws std::invalid_argument when a bond is as long as half the cell, or a grain is
/// bonded to its own image.
std::vector<Vector3> whole_positions(const Packing& packing, const Box& box, std::span<const Vector3> position);

} // namespace boba
