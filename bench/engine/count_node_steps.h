// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stepper.h"

#include <benchmark/benchmark.h>

namespace boba::bench {

/// Node-steps a second, where each iteration is one step.
inline void count_node_steps(benchmark::State& state, const Stepper& stepper) {
  const auto nodes = static_cast<double>(stepper.packing().first_nodes().back());
  state.counters["node_steps"] =
      benchmark::Counter(nodes * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

} // namespace boba::bench
