// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene does not need is not done: the same steps with and without each part, on one dense packing.
#include "bench/engine/dense_packing.h"

#include <benchmark/benchmark.h>
#include <memory>

namespace boba::bench {
namespace {

/// Too small to change any number, yet not zero: the part is evaluated.
constexpr double next_to_nothing = 1e-200;

struct Steps {
  double alpha = 2.0;          ///< of the packing that is loaded: 0 or 2
  double computed_alpha = 2.0; ///< of the grains
  double gamma = Material{}.gamma;
  Virial virial = Virial::trace;
  bool cell_moves = true;
};

void step(benchmark::State& state, const Steps& steps) {
  Packing packing = dense_packing(16, 5137, steps.alpha);
  for (Grain& grain : packing.grains) {
    grain.alpha = steps.computed_alpha;
  }
  Material material;
  material.gamma = steps.gamma;
  Stepper stepper(packing, material, SimulationOptions{});
  stepper.start();
  for (auto _ : state) {
    stepper.advance(steps.virial);
    stepper.move_cell(steps.cell_moves ? dense_shear_rates(0.0) : CellRates{});
  }
  const double nodes = static_cast<double>(packing.position.size());
  state.counters["node_steps"] =
      benchmark::Counter(nodes * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void add(const char* name, const Steps& steps) {
  benchmark::RegisterBenchmark(name, [steps](benchmark::State& state) { step(state, steps); })
      ->Unit(benchmark::kMillisecond)
      ->Iterations(200)
      ->UseRealTime();
}

const bool added = [] {
  const Steps all{};
  const Steps spring{.alpha = 0.0, .computed_alpha = 0.0};
  Steps s = spring;
  s.computed_alpha = next_to_nothing;
  add("skip/many_body_at_alpha_0/with", s);
  add("skip/many_body_at_alpha_0/without", spring);
  s = all;
  s.gamma = next_to_nothing;
  add("skip/damping_at_gamma_0/with", s);
  s.gamma = 0.0;
  add("skip/damping_at_gamma_0/without", s);
  s = all;
  s.virial = Virial::full;
  add("skip/whole_stress_each_step/with", s);
  add("skip/whole_stress_each_step/without", all);
  s = all;
  s.virial = Virial::none;
  add("skip/pressure_nobody_reads/with", all);
  add("skip/pressure_nobody_reads/without", s);
  s = all;
  s.cell_moves = false;
  add("skip/remap_in_a_fixed_cell/with", all);
  add("skip/remap_in_a_fixed_cell/without", s);
  return true;
}();

} // namespace
} // namespace boba::bench
