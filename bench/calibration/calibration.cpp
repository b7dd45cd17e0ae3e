// SPDX-License-Identifier: GPL-3.0-or-later
// The five-value sweep against the number of nodes, against the tolerance (with the error it leaves), and with the
// assembled operator. PETSC_OPTIONS="-network_ksp_type ... -network_pc_type ..." compares solvers. Boxes come from the
// template cache.
#include "bpm/grain/template_cache.h"
#include "calibration/network/network_stiffness.h"

#include <benchmark/benchmark.h>
#include <cmath>

namespace {

using namespace boba;
using namespace boba::calibration;

const std::vector<double> alphas = {-0.8, 0.0, 2.0, 5.0, 12.0};

GrainTemplate box(int n_nodes) {
  return TemplateCache().get({.shape = TemplateSpec::Shape::periodic_box, .size = {1, 1, 1}, .n_nodes = n_nodes});
}

void run(benchmark::State& state, int n_nodes, const SolveSettings& settings) {
  const GrainTemplate grain = box(n_nodes);
  int iterations = 0;
  std::vector<StiffnessSolution> solutions;
  for (auto _ : state) {
    solutions = relaxed_stiffness(LinearNetwork(grain), alphas, settings);
    iterations = 0;
    for (const StiffnessSolution& solution : solutions) {
      iterations += solution.iterations;
    }
  }
  state.counters["nodes"] = n_nodes;
  state.counters["iterations"] = iterations;
  if (settings.relative_tolerance > 1e-9 && n_nodes <= 4000) {
    const auto exact = relaxed_stiffness(LinearNetwork(grain), alphas, {.relative_tolerance = 1e-10});
    double error = 0.0;
    for (std::size_t a = 0; a < alphas.size(); ++a) {
      error = std::max(error, (solutions[a].stiffness - exact[a].stiffness).norm() / exact[a].stiffness.norm());
    }
    state.counters["error"] = error;
  }
}

void sweep(benchmark::State& state) {
  run(state, static_cast<int>(state.range(0)), {});
}
void tolerance(benchmark::State& state) {
  run(state, 4000, {.relative_tolerance = std::pow(10.0, -static_cast<double>(state.range(0)))});
}
void assembled(benchmark::State& state) {
  run(state, static_cast<int>(state.range(0)), {.assembled = true});
}

BENCHMARK(sweep)->Arg(1000)->Arg(4000)->Arg(20000)->Unit(benchmark::kSecond)->Iterations(1);
BENCHMARK(tolerance)->DenseRange(2, 8, 2)->Unit(benchmark::kSecond)->Iterations(1);
BENCHMARK(assembled)->Arg(1000)->Arg(4000)->Unit(benchmark::kSecond)->Iterations(1);

} // namespace

int main(int argc, char** argv) {
  const PetscSession petsc;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
