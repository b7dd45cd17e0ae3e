// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of a dense shear at P~ = 0.1 with contacts and barostat: node-steps per second and the share of each part.
#include "bench/engine/dense_packing.h"

#include <benchmark/benchmark.h>

#include <map>
#include <tuple>

namespace boba::bench {
namespace {

/// Packings are expensive to make: one for each size and alpha, shared by the benchmarks that need it.
DensePacking& packing_of(int n_grains, int n_nodes, double alpha, int threads) {
  static std::map<std::tuple<int, int, double, int>, DensePacking> made;
  const auto key = std::make_tuple(n_grains, n_nodes, alpha, threads);
  const auto found = made.find(key);
  return found != made.end() ? found->second
                             : made.emplace(key, make_dense_packing(n_grains, n_nodes, alpha, threads)).first->second;
}

/// Arguments: grains, nodes a grain, alpha, threads. One iteration is one step at the paper's fastest rate.
void dense_shear(benchmark::State& state) {
  DensePacking& dense = packing_of(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
                                   static_cast<double>(state.range(2)), static_cast<int>(state.range(3)));
  Stepper& stepper = *dense.stepper;
  const Timings before = stepper.timings();
  for (auto _ : state) {
    stepper.advance(Virial::trace);
    stepper.move_cell({.shear = 1.024e-3, .dilation = dense.gain * (stepper.pressure() - dense.pressure)});
  }
  const Timings after = stepper.timings();
  const double nodes = static_cast<double>(stepper.packing().position.size());
  const double steps = static_cast<double>(state.iterations());
  const double all = (after.bonds - before.bonds) + (after.contacts - before.contacts) + (after.search - before.search) +
                     (after.integration - before.integration);
  state.counters["node_steps"] = benchmark::Counter(nodes * steps, benchmark::Counter::kIsRate);
  state.counters["bonds_%"] = 100.0 * (after.bonds - before.bonds) / all;
  state.counters["contacts_%"] = 100.0 * (after.contacts - before.contacts) / all;
  state.counters["search_%"] = 100.0 * (after.search - before.search) / all;
  state.counters["drift_%"] = 100.0 * (after.integration - before.integration) / all;
  state.counters["steps_per_list"] =
      steps / std::max(1.0, static_cast<double>(after.list_builds - before.list_builds));
  state.counters["bytes_per_node"] = static_cast<double>(stepper.bytes()) / nodes;
  state.SetLabel(stepper.forces().kernel_table().name);
}

/// The volume pass alone on the same packing: what alpha != 0 adds before any force is known.
void node_volumes(benchmark::State& state) {
  DensePacking& dense = packing_of(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), 2.0, 1);
  for (auto _ : state) {
    dense.stepper->volumes_only();
  }
  const double nodes = static_cast<double>(dense.stepper->packing().position.size());
  state.counters["node_steps"] =
      benchmark::Counter(nodes * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK(dense_shear)
    ->ArgNames({"grains", "nodes", "alpha", "threads"})
    ->Args({16, 5137, 2, 1})
    ->Args({16, 5137, 0, 1})
    ->Args({64, 5137, 2, 1})
    ->Args({64, 5137, 0, 1})
    ->Args({64, 5137, 2, 2})
    ->Args({64, 300, 2, 1})
    ->Unit(benchmark::kMillisecond)
    ->MinTime(3.0)
    ->UseRealTime();
BENCHMARK(node_volumes)->ArgNames({"grains", "nodes"})->Args({16, 5137})->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
} // namespace boba::bench

BENCHMARK_MAIN();
