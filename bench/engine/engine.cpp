// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of a dense shear at P~ = 0.1 with contacts and barostat: node-steps per second and the share of each part.
#include "bench/engine/dense_packing.h"

#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <tuple>

namespace boba::bench {
namespace {

/// One stepper for each size, alpha, number of threads and precision, shared by the benchmarks that need it.
Stepper& stepper_of(int n_grains, int n_nodes, double alpha, int threads, Precision precision = Precision::full) {
  static std::map<std::tuple<int, int, double, int, Precision>, std::unique_ptr<Stepper>> made;
  std::unique_ptr<Stepper>& stepper = made[{n_grains, n_nodes, alpha, threads, precision}];
  if (!stepper) {
    stepper = std::make_unique<Stepper>(dense_packing(n_grains, n_nodes, alpha), Material{},
                                        SimulationOptions{.threads = threads, .precision = precision});
    stepper->start();
  }
  return *stepper;
}

/// Arguments: grains, nodes a grain, alpha, threads, precision (1: mixed). One iteration is one step at the paper's
/// fastest rate.
void dense_shear(benchmark::State& state) {
  const auto alpha = static_cast<double>(state.range(2));
  Stepper& stepper =
      stepper_of(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), alpha,
                 static_cast<int>(state.range(3)), state.range(4) != 0 ? Precision::mixed : Precision::full);
  const double pressure = dense_pressure(alpha);
  const Timings before = stepper.timings();
  for (auto _ : state) {
    stepper.advance(Virial::trace);
    stepper.move_cell(dense_shear_rates(stepper.pressure() - pressure));
  }
  const Timings after = stepper.timings();
  const double nodes = static_cast<double>(stepper.packing().position.size());
  const double steps = static_cast<double>(state.iterations());
  const double all = (after.bonds - before.bonds) + (after.contacts - before.contacts) +
                     (after.search - before.search) + (after.integration - before.integration);
  state.counters["node_steps"] = benchmark::Counter(nodes * steps, benchmark::Counter::kIsRate);
  state.counters["bonds_%"] = 100.0 * (after.bonds - before.bonds) / all;
  state.counters["contacts_%"] = 100.0 * (after.contacts - before.contacts) / all;
  state.counters["search_%"] = 100.0 * (after.search - before.search) / all;
  state.counters["drift_%"] = 100.0 * (after.integration - before.integration) / all;
  const ContactList::Counts& listed = stepper.forces().contact_list().counts();
  const double all_steps = static_cast<double>(after.steps);
  const double n_grains = stepper.layout().n_grains();
  state.counters["steps_per_update"] = all_steps / static_cast<double>(listed.updates);
  state.counters["steps_per_note"] = all_steps * n_grains / static_cast<double>(listed.grains);
  state.counters["steps_per_pair_search"] = all_steps *
                                            static_cast<double>(stepper.forces().contact_list().pairs().size()) /
                                            static_cast<double>(listed.pairs);
  state.counters["nodes_looked_up/step"] = static_cast<double>(listed.nodes) / all_steps;
  state.counters["bytes_per_node"] = static_cast<double>(stepper.bytes()) / nodes;
  state.counters["candidates/node"] = static_cast<double>(stepper.forces().contact_list().n_candidates()) / nodes;
  state.counters["contacts/node"] = static_cast<double>(stepper.forces().contact_totals().n_touching) / nodes;
  state.SetLabel(stepper.forces().kernel_table().name);
}

/// The volume pass alone on the same packing: what alpha != 0 adds before any force is known.
void node_volumes(benchmark::State& state) {
  Stepper& stepper = stepper_of(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), 2.0, 1);
  for (auto _ : state) {
    stepper.volumes_only();
  }
  const double nodes = static_cast<double>(stepper.packing().position.size());
  state.counters["node_steps"] =
      benchmark::Counter(nodes * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

BENCHMARK(dense_shear)
    ->ArgNames({"grains", "nodes", "alpha", "threads", "mixed"})
    ->ArgsProduct({{16}, {5137}, {2, 0}, {1}, {0, 1}})
    ->ArgsProduct({{64}, {5137}, {2, 0}, {1, 2}, {0, 1}})
    ->ArgsProduct({{8}, {5137}, {2}, {1, 2}, {0, 1}})
    ->ArgsProduct({{64}, {300}, {2}, {1}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->MinTime(3.0)
    ->UseRealTime();
BENCHMARK(node_volumes)->ArgNames({"grains", "nodes"})->Args({16, 5137})->Unit(benchmark::kMillisecond)->UseRealTime();

} // namespace
} // namespace boba::bench

BENCHMARK_MAIN();
