// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/linear_network.h"

namespace boba::calibration {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// The linearised network of a grain whose bonds can hold every node in place.
/// \throws std::invalid_argument when a node floats or the network is in pieces (see boba::floating_part).
LinearNetwork connected_network(const GrainTemplate& grain);

} // namespace boba::calibration
