// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/stability/cases.h"

#include "bpm/dynamics/take_snapshot.h"
#include "bpm/grain/random.h"
#include "bpm/grain/template_cache.h"
#include "bpm/packing/insertion.h"
#include "bpm/stages/compress.h"

#include <array>
#include <cmath>

namespace boba::bench {

std::shared_ptr<const GrainTemplate> ball(int n_nodes, std::uint64_t seed) {
  TemplateSpec spec;
  spec.n_nodes = n_nodes;
  spec.seed = seed;
  return std::make_shared<const GrainTemplate>(TemplateCache().get(spec));
}

std::shared_ptr<const GrainTemplate> periodic_cube(double edge) {
  TemplateSpec spec;
  spec.shape = TemplateSpec::Shape::periodic_box;
  spec.size = Eigen::Vector3d::Constant(edge);
  return std::make_shared<const GrainTemplate>(TemplateCache().get(spec));
}

void shake(Packing& packing, double speed, std::uint64_t seed) {
  Random random(seed);
  for (Vector3& v : packing.velocity) {
    v = random.vector(speed);
  }
}

Packing lone_grain(std::shared_ptr<const GrainTemplate> grain, double alpha, double speed) {
  const Box open({-50, -50, -50}, {100, 100, 100}, {0, 0, 0}, {false, false, false});
  Placement placement;
  placement.grain.alpha = alpha;
  Packing packing = make_packing(open, {std::move(grain)}, {placement});
  shake(packing, speed);
  return packing;
}

Packing bulk(std::shared_ptr<const GrainTemplate> grain, double alpha) {
  const Vector3 edges = *grain->period;
  Placement placement;
  placement.grain.alpha = alpha;
  return make_packing(Box(-0.5 * edges, edges), {std::move(grain)}, {placement});
}

double pressure_of(double normalised, double alpha) {
  struct Pair {
    double alpha, nu, e;
  };
  constexpr std::array<Pair, 5> pairs = {
      {{-0.8, 0.40, 0.58}, {0.0, 0.25, 1.84}, {2.0, -0.01, 4.05}, {5.0, -0.25, 6.04}, {12.0, -0.52, 8.30}}};
  std::size_t i = 0;
  while (i + 2 < pairs.size() && alpha > pairs[i + 1].alpha) {
    ++i;
  }
  const double t = std::min((alpha - pairs[i].alpha) / (pairs[i + 1].alpha - pairs[i].alpha), 1.0);
  const double nu = pairs[i].nu + t * (pairs[i + 1].nu - pairs[i].nu);
  const double e = pairs[i].e + t * (pairs[i + 1].e - pairs[i].e);
  return normalised * e / (2.0 - 2.0 * nu * nu);
}

Packing packing_of(const Packing& original, const Snapshot& snapshot) {
  Packing packing = original;
  packing.box = snapshot.box;
  packing.position = snapshot.position;
  packing.velocity = snapshot.velocity;
  packing.velocity.resize(packing.position.size(), Vector3::Zero());
  return packing;
}

Packing compressed(const PackingSpec& spec) {
  Insertion insertion;
  insertion.templates = {ball(spec.n_nodes)};
  insertion.grains.assign(spec.n_grains, Grain{.alpha = spec.alpha});
  insertion.packing_fraction = 0.28;
  const Packing loose = insert_at_random(insertion);
  Stepper stepper(loose, Material{}, SimulationOptions{.dt = 0.05});
  CompressDriver driver({.barostat = {.pressure = pressure_of(spec.pressure, spec.alpha)},
                         .rate = 1e-3,
                         .pressure_tolerance = spec.tolerance,
                         .kinetic_tolerance = spec.tolerance,
                         .max_time = 3e4});
  stepper.start();
  driver.begin(stepper);
  while (!driver.finished()) {
    stepper.advance(driver.may_end(stepper) ? Virial::full : Virial::trace);
    stepper.move_cell(driver.update(stepper));
  }
  return packing_of(loose, take_snapshot(stepper.moving(), {}));
}

OutputFile csv(const Folder& folder, const std::string& name, const std::string& header) {
  std::filesystem::create_directories(folder);
  OutputFile file(folder / (name + ".csv"), FileMode::overwrite);
  file.write(header + "\n");
  return file;
}

} // namespace boba::bench
