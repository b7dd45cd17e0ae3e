// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

#include <cstdint>

namespace boba::calibration {

/// A disordered periodic cube, kept in a cache of the build folder because many cases share it.
GrainTemplate test_box(int n_nodes, std::uint64_t seed = 1);

/// A cylinder cut from the bulk, from the same cache.
GrainTemplate test_cylinder(double radius, double height);

/// A face-centred cubic crystal of m^3 cells with nearest neighbours at distance 1, bonded to them alone.
GrainTemplate fcc_box(int m);

} // namespace boba::calibration
