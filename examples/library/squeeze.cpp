// SPDX-License-Identifier: GPL-3.0-or-later
// Eight soft grains are inserted at random, compressed to a pressure and sheared; then their arrays are read.
#include "bpm/dynamics/simulation.h"
#include "bpm/grain/build_template.h"
#include "bpm/measure/stress.h"
#include "bpm/packing/insertion.h"
#include "bpm/stages/compress.h"
#include "bpm/stages/shear.h"

#include <cstdio>
#include <cstdlib>
#include <exception>

int main() try {
  // A sphere of 60 nodes; all grains share its bonds.
  boba::TemplateSpec sphere;
  sphere.n_nodes = 60;

  boba::Insertion insertion;
  insertion.templates = {std::make_shared<const boba::GrainTemplate>(boba::build_template(sphere))};
  insertion.grains.assign(8, boba::Grain{.alpha = 2.0}); // k d: Poisson's ratio close to 0
  insertion.packing_fraction = 0.3;
  const boba::Packing packing = boba::insert_at_random(insertion);
  const boba::Topology topology = packing.topology(false);

  boba::Simulation simulation(packing, boba::Material{}, {.dt = 0.1, .threads = 2});
  simulation.run(0, boba::CompressDriver({.barostat = {.pressure = 0.05}, .rate = 2e-3}), {});
  std::printf("pressure %.6f k/d\n", simulation.totals().pressure);

  simulation.run(1, boba::ShearDriver({.rate = 1e-3, .strain = 0.1}), {});
  const boba::Snapshot snapshot = simulation.snapshot({.velocity = true, .force = true});
  const auto stress = boba::measure::summarise_stress(simulation.totals().stress);
  std::printf("strain %.4f, mu %.4f\n", simulation.strain(), stress.mu);
  for (int grain = 0; grain < topology.n_grains(); ++grain) {
    const boba::Vector3& centre = snapshot.grain_centre[grain];
    std::printf("grain %d: %zu nodes, centre %.4f %.4f %.4f\n", grain, snapshot.nodes_of(topology, grain).size(),
                centre.x(), centre.y(), centre.z());
  }
  return EXIT_SUCCESS;
} catch (const std::exception& error) {
  std::fprintf(stderr, "squeeze: %s\n", error.what());
  return EXIT_FAILURE;
}
