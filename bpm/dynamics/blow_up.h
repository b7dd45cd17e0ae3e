// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/bond_survey.h"
#include "bpm/laws/material.h"
#include "bpm/packing/lane_state.h"

#include <string>

namespace boba {

/// Largest r / r0 of a bond before a run is stopped.
inline constexpr double largest_bond_stretch = 3.0;

/// Names the fastest (or not finite) node of a block, its grain, the step, and the likely cause.
std::string describe_fast_node(const Block& block, const LaneState& state, std::int64_t step, double dt,
                               const Material& material);

/// The same for a grain whose nodes are too far from its centre for fixed-point positions.
std::string describe_torn_grain(double share, std::int64_t step, double dt);

/// The same for a block of grains whose velocities turn round at every step; `moved` in d a step, root mean square.
std::string describe_alternation(const Block& block, std::int64_t step, double dt, double moved);

/// The same for a bond that is stretched beyond `largest_bond_stretch`.
std::string describe_stretched_bond(const Stretch& stretch, std::int64_t step, double dt);

} // namespace boba
