// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/engine/dense_packing.h"

#include "bpm/dynamics/stage_driver.h"
#include "bpm/grain/template_cache.h"
#include "bpm/packing/insertion.h"

#include <stdexcept>

namespace boba::bench {

namespace {

/// P at P~ = P (2 - 2 nu^2) / E = 0.1 with the pairs published by Clemmer, Hackney & Grest.
double target_pressure(double alpha) {
  if (alpha == 0.0) {
    return 0.1 * 1.84 / (2.0 - 2.0 * 0.25 * 0.25);
  }
  if (alpha == 2.0) {
    return 0.1 * 4.05 / (2.0 - 2.0 * 0.01 * 0.01);
  }
  throw std::invalid_argument("dense packing: alpha must be 0 or 2");
}

} // namespace

DensePacking make_dense_packing(int n_grains, int n_nodes, double alpha, int threads) {
  TemplateSpec spec;
  spec.n_nodes = n_nodes;
  Insertion insertion;
  insertion.templates = {std::make_shared<const GrainTemplate>(TemplateCache().get(spec))};
  insertion.grains.assign(n_grains, Grain{.alpha = alpha});
  insertion.packing_fraction = 0.38;

  DensePacking dense;
  dense.pressure = target_pressure(alpha);
  dense.stepper = std::make_unique<Stepper>(insert_at_random(insertion), Material{}, SimulationOptions{.threads = threads});
  const auto driver = make_stage_driver(CompressStage{.barostat = {.pressure = dense.pressure},
                                                      .rate = 2e-3,
                                                      .pressure_tolerance = 0.01,
                                                      .kinetic_tolerance = 1e-2});
  dense.stepper->start();
  driver->begin(*dense.stepper);
  while (!driver->finished()) {
    dense.stepper->advance(Virial::trace);
    dense.stepper->move_cell(driver->update(*dense.stepper));
  }
  dense.gain = 0.02;
  return dense;
}

} // namespace boba::bench
