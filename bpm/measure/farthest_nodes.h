// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/box.h"

#include <span>
#include <vector>

namespace boba::measure {

/// For each direction the number of a node that reaches farthest along it, in floating point (the lowest number of
/// those that reach equally far).
std::vector<int> farthest_nodes(std::span<const Vector3> nodes, std::span<const Vector3> directions);

} // namespace boba::measure
