// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/engine/skips.h"

#include "base/bounds.h"
#include "bpm/grain/template_cache.h"

#include <algorithm>

namespace boba::bench {

void register_skip(const std::string& name, int steps, const std::function<void(benchmark::State&)>& run) {
  benchmark::RegisterBenchmark(("skip/" + name).c_str(), run)
      ->Unit(benchmark::kMillisecond)
      ->Iterations(steps)
      ->UseRealTime();
}

Packing swinging_grains(const Lattice& lattice) {
  TemplateSpec spec;
  spec.n_nodes = 5137;
  const auto grain = std::make_shared<const GrainTemplate>(TemplateCache().get(spec));
  const Vector3 apart = bounds_of(grain->position).extent() + Vector3::Constant(lattice.gap);
  const Eigen::Array3i number = lattice.alone ? Eigen::Array3i(1, 1, 1) : Eigen::Array3i(4, 2, 2);
  std::vector<Placement> placements;
  for (int g = 0; g < number.prod(); ++g) {
    const int row = g / number[0];
    const Eigen::Vector3d cell = Eigen::Vector3i(g % number[0], row % number[1], row / number[1]).cast<double>();
    placements.push_back({Grain{.alpha = 2.0}, apart.cwiseProduct(cell + Vector3::Constant(0.5))});
  }
  const bool p = lattice.periodic;
  const Box box(Vector3::Zero(), apart.cwiseProduct(number.cast<double>().matrix()), Vector3::Zero(), {p, p, p});
  Packing packing = make_packing(box, {grain}, placements);
  const double speed = 0.05 / (0.5 * (apart.maxCoeff() - lattice.gap)); // of the nodes farthest out
  for (std::size_t i = 0; i < packing.position.size(); ++i) {
    const Vector3 from_centre = packing.position[i] - placements[i / grain->position.size()].centre;
    packing.velocity[i] = speed * Vector3(-from_centre[0], from_centre[1], 0.0);
  }
  return packing;
}

} // namespace boba::bench
