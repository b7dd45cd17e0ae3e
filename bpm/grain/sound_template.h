// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

#include <optional>
#include <string>

namespace boba {

/// Positions of files beyond this are refused, d: doubles there resolve 1e-7 d, and products do not overflow.
inline constexpr double largest_coordinate = 1e9;
/// Rest lengths of files, d.
inline constexpr double shortest_rest_length = 1e-6, longest_rest_length = 1e6;

/// Every component is a number from -largest_coordinate to largest_coordinate.
inline bool is_usable_position(const Eigen::Vector3d& x) {
  return (x.array().abs() <= largest_coordinate).all(); // false for NaN
}

/// First reason why a template that comes from a file cannot be used, or nothing.
///
/// Refused: no nodes, a position beyond largest_coordinate, a bond of nodes that are not there, with i >= j, out of
/// order, twice, or of a length outside shortest_rest_length to longest_rest_length, a period or a volume that is not
/// positive.
std::optional<std::string> unsound_part(const GrainTemplate& grain);

} // namespace boba
