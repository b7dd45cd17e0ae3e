// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace boba {

/// A bond between every pair closer than `cutoff` (d), with r0 the pair's distance; sorted by (i, j), i < j.
/// Positions of a periodic network lie in [-period/2, period/2).
std::vector<Bond> bonds_closer_than(const std::vector<Eigen::Vector3d>& position, double cutoff,
                                    const std::optional<Eigen::Vector3d>& period);

/// First reason why the network cannot hold every node in place, or nothing.
///
/// Refused: a node whose bond directions e do not span space firmly (smallest eigenvalue of sum e e^T below 0.05, which
/// takes in every node with fewer than three bonds), and a network in more than one piece.
std::optional<std::string> floating_part(const GrainTemplate& grain);

} // namespace boba
