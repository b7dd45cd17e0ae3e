// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stepper.h"

#include <string>

namespace boba::bench {

/// What it costs to measure a frame of the present state on all ranks: a snapshot with the nodes on all of them, and
/// those measures that they take together (sensitivity of facets, scattering to q = 1/d and Voronoi radii included).
/// Collective.
///
/// JSON: best of some frames, s by the clock and of the slowest rank's processor, whole and kind by kind.
std::string time_frame(const Stepper& stepper, const Ranks& ranks, int n_frames);

} // namespace boba::bench
