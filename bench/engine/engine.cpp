// SPDX-License-Identifier: GPL-3.0-or-later
// Speed of a dense shear at P~ = 0.1 with contacts and barostat: node-steps per second and the share of each part.
#include "bench/engine/count_node_steps.h"
#include "bench/engine/dense_packing.h"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <compare>
#include <map>
#include <memory>

namespace boba::bench {
namespace {

/// Until vibrations of the faster shear before have died away.
constexpr int steps_to_settle = 4000;

struct Scene {
  int grains, nodes;
  double alpha;
  int threads;
  Precision precision;
  double rate;
  auto operator<=>(const Scene&) const = default;
};

/// One step of shear at P~ = 0.1.
void shear(Stepper& stepper, const Scene& scene) {
  stepper.advance(Virial::trace);
  stepper.move_cell(dense_shear_rates(stepper.pressure() - dense_pressure(scene.alpha), scene.rate));
}

/// One stepper for each scene, shared by the benchmarks that need it.
Stepper& stepper_of(const Scene& scene) {
  static std::map<Scene, std::unique_ptr<Stepper>> made;
  std::unique_ptr<Stepper>& stepper = made[scene];
  if (!stepper) {
    stepper = std::make_unique<Stepper>(dense_packing(scene.grains, scene.nodes, scene.alpha), Material{},
                                        SimulationOptions{.threads = scene.threads, .precision = scene.precision});
    stepper->start();
    for (int step = 0; scene.rate < fastest_rate && step < steps_to_settle; ++step) {
      shear(*stepper, scene);
    }
  }
  return *stepper;
}

/// Arguments: grains, nodes a grain, alpha, threads, precision (1: mixed). One iteration is one step at this rate.
void dense_shear(benchmark::State& state, double rate) {
  const Scene scene = {static_cast<int>(state.range(0)),
                       static_cast<int>(state.range(1)),
                       static_cast<double>(state.range(2)),
                       static_cast<int>(state.range(3)),
                       state.range(4) != 0 ? Precision::mixed : Precision::full,
                       rate};
  Stepper& stepper = stepper_of(scene);
  const Timings before = timings_of(stepper.moving());
  const ContactList::Counts counts = stepper.forces().contact_list().counts();
  for (auto _ : state) {
    shear(stepper, scene);
  }
  const Timings after = timings_of(stepper.moving());
  const double nodes = static_cast<double>(stepper.packing().position.size());
  const double steps = static_cast<double>(state.iterations());
  const double all = (after.bonds - before.bonds) + (after.contacts - before.contacts) +
                     (after.search - before.search) + (after.integration - before.integration);
  count_node_steps(state, stepper);
  state.counters["bonds_%"] = 100.0 * (after.bonds - before.bonds) / all;
  state.counters["contacts_%"] = 100.0 * (after.contacts - before.contacts) / all;
  state.counters["search_%"] = 100.0 * (after.search - before.search) / all;
  state.counters["drift_%"] = 100.0 * (after.integration - before.integration) / all;
  const ContactList& list = stepper.forces().contact_list();
  const auto steps_per = [&](std::int64_t n, std::int64_t n_before, double of) {
    return steps * of / static_cast<double>(std::max<std::int64_t>(1, n - n_before));
  };
  state.counters["steps_per_update"] = steps_per(list.counts().updates, counts.updates, 1.0);
  state.counters["steps_per_note"] = steps_per(list.counts().grains, counts.grains, stepper.layout().n_grains());
  state.counters["steps_per_pair_search"] =
      steps_per(list.counts().pairs, counts.pairs, static_cast<double>(list.pairs().size()));
  state.counters["nodes_looked_up/step"] = static_cast<double>(list.counts().nodes - counts.nodes) / steps;
  state.counters["bytes_per_node"] = static_cast<double>(bytes_of(stepper.moving())) / nodes;
  state.counters["candidates/node"] = static_cast<double>(list.n_candidates()) / nodes;
  state.counters["contacts/node"] = static_cast<double>(stepper.forces().contact_totals().n_touching) / nodes;
  state.SetLabel(stepper.forces().kernel_table().name);
}

/// The volume pass alone on the same packing: what alpha != 0 adds before any force is known.
void node_volumes(benchmark::State& state) {
  Stepper& stepper = stepper_of(
      {static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), 2.0, 1, Precision::full, fastest_rate});
  for (auto _ : state) {
    stepper.forces().bonds().volumes_only(stepper.moving().state);
  }
  count_node_steps(state, stepper);
}

BENCHMARK_CAPTURE(dense_shear, slowest, slowest_rate)
    ->ArgNames({"grains", "nodes", "alpha", "threads", "mixed"})
    ->ArgsProduct({{16}, {5137}, {2, 0}, {1}, {0, 1}})
    ->Unit(benchmark::kMillisecond)
    ->MinTime(3.0)
    ->UseRealTime();
BENCHMARK_CAPTURE(dense_shear, fastest, fastest_rate)
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
