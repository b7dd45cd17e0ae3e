// SPDX-License-Identifier: GPL-3.0-or-later
// Grains of one node each, Hertz spheres: node-steps per second against their number.
#include "bench/engine/count_node_steps.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/grain/build_template.h"
#include "bpm/packing/insertion.h"
#include "bpm/stages/compress.h"

#include <algorithm>
#include <benchmark/benchmark.h>
#include <memory>

namespace boba::bench {
namespace {

const Material spheres = {.gamma = 0.1, .contact = "hertz", .contact_parameters = {1.0}};
constexpr double pressure = 0.1, rate = 1e-2; ///< k/d with E / (2 - 2 nu^2) = 1 k/d: P~; 1/tau

/// At a packing fraction of 0.5, or compressed to P~ = 0.1 from there.
std::unique_ptr<Stepper> stepper_of(int n_grains, bool is_dense, int threads) {
  Insertion insertion;
  insertion.templates = {std::make_shared<const GrainTemplate>(build_template({.n_nodes = 1}))};
  insertion.grains.assign(n_grains, Grain{.alpha = 0.0});
  insertion.packing_fraction = 0.5;
  auto stepper = std::make_unique<Stepper>(insert_at_random(insertion), spheres, SimulationOptions{.threads = threads});
  stepper->start();
  if (is_dense) {
    CompressDriver driver(
        {.barostat = {.pressure = pressure}, .rate = 2e-3, .pressure_tolerance = 0.02, .kinetic_tolerance = 0.1});
    driver.begin(*stepper);
    while (!driver.finished()) {
      stepper->advance(Virial::trace);
      stepper->move_cell(driver.update(*stepper));
    }
  }
  return stepper;
}

/// Arguments: grains, whether they are compressed, threads. One iteration is one step of shear, the pressure read.
void single_nodes(benchmark::State& state) {
  const auto stepper =
      stepper_of(static_cast<int>(state.range(0)), state.range(1) != 0, static_cast<int>(state.range(2)));
  const auto step = [&] {
    stepper->advance(Virial::trace);
    stepper->move_cell({.shear = rate});
  };
  for (int k = 0; k < 200; ++k) { // until the shear has set all in motion
    step();
  }
  const std::int64_t builds = stepper->forces().n_list_builds();
  for (auto _ : state) {
    step();
  }
  count_node_steps(state, *stepper);
  state.counters["steps_of_a_list"] =
      static_cast<double>(state.iterations()) /
      static_cast<double>(std::max<std::int64_t>(1, stepper->forces().n_list_builds() - builds));
}

BENCHMARK(single_nodes)
    ->ArgNames({"grains", "dense", "threads"})
    ->ArgsProduct({{256, 1024, 4096}, {0, 1}, {1}})
    ->ArgsProduct({{32768, 100000}, {0}, {1, 2}})
    ->Unit(benchmark::kMicrosecond)
    ->MinTime(1.0)
    ->UseRealTime();

} // namespace
} // namespace boba::bench
