// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/packing.h"

#include <benchmark/benchmark.h>
#include <functional>
#include <string>

namespace boba::bench {

/// A part that is not done where nothing needs it: the same steps with and without it. Registered as skip/NAME, to be
/// read in ms a step.
void register_skip(const std::string& name, int steps, const std::function<void(benchmark::State&)>& run);

/// Grains of 5137 nodes on a cubic lattice, 4 x 2 x 2 of them or one alone, with `gap` between their bounding boxes and
/// those of their images (d). Each is being squeezed along x and drawn out along y at 0.05 d/tau, so that shapes and
/// distances change.
struct Lattice {
  bool alone = false;
  double gap = 8.0;
  bool periodic = true;
};
Packing swinging_grains(const Lattice& lattice);

} // namespace boba::bench
