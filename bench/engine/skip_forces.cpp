// SPDX-License-Identifier: GPL-3.0-or-later
// What forces and the cell's motion need not do: on one dense packing.
#include "bench/engine/count_node_steps.h"
#include "bench/engine/dense_packing.h"
#include "bench/engine/skips.h"

namespace boba::bench {
namespace {

/// Too small to change any number, yet not zero: the part is evaluated.
constexpr double next_to_nothing = 1e-200;

struct Steps {
  double alpha = 2.0; ///< of the packing that is loaded: 0 or 2
  /// Of the grains, in turn.
  std::array<double, 2> computed_alpha = {2.0, 2.0};
  double gamma = Material{}.gamma;
  Virial virial = Virial::trace;
  bool cell_moves = true;
};

void step(benchmark::State& state, const Steps& steps) {
  Packing packing = dense_packing(16, 5137, steps.alpha);
  for (int g = 0; g < packing.n_grains(); ++g) {
    packing.grains[g].alpha = steps.computed_alpha[g % 2];
  }
  Material material;
  material.gamma = steps.gamma;
  Stepper stepper(packing, material, SimulationOptions{});
  stepper.start();
  for (auto _ : state) {
    stepper.advance(steps.virial);
    stepper.move_cell(steps.cell_moves ? dense_shear_rates(0.0) : CellRates{});
  }
  count_node_steps(state, stepper);
}

void add(const char* name, const Steps& steps) {
  register_skip(name, 200, [steps](benchmark::State& state) { step(state, steps); });
}

const bool added = [] {
  const Steps all{};
  const Steps spring{.alpha = 0.0, .computed_alpha = {0.0, 0.0}};
  Steps s = spring;
  s.computed_alpha = {next_to_nothing, next_to_nothing};
  add("many_body_at_alpha_0/with", s);
  add("many_body_at_alpha_0/without", spring);
  add("many_body_of_the_other_half/with", s);
  s.computed_alpha = {0.0, next_to_nothing}; // blocks of either kind, none of both
  add("many_body_of_the_other_half/without", s);
  s = all;
  s.gamma = next_to_nothing;
  add("damping_at_gamma_0/with", s);
  s.gamma = 0.0;
  add("damping_at_gamma_0/without", s);
  s = all;
  s.virial = Virial::full;
  add("whole_stress_each_step/with", s);
  add("whole_stress_each_step/without", all);
  s = all;
  s.virial = Virial::none;
  add("pressure_nobody_reads/with", all);
  add("pressure_nobody_reads/without", s);
  s = all;
  s.cell_moves = false;
  add("remap_in_a_fixed_cell/with", all);
  add("remap_in_a_fixed_cell/without", s);
  return true;
}();

} // namespace
} // namespace boba::bench
