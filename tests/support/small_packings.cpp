// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/small_packings.h"

#include <random>
#include <stdexcept>

namespace boba::test {

namespace {

class Uniform {
public:
  explicit Uniform(std::uint64_t seed) : generator_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1.0p-53;
  }
  Vector3 in_cube(double half) { return {(*this)(-half, half), (*this)(-half, half), (*this)(-half, half)}; }

private:
  std::mt19937_64 generator_;
};

} // namespace

std::shared_ptr<const GrainTemplate> small_ball(double radius, std::uint64_t seed) {
  Uniform uniform(seed);
  auto grain = std::make_shared<GrainTemplate>();
  for (int failures = 0; failures < 200;) {
    const Vector3 x = uniform.in_cube(radius);
    bool free = x.norm() <= radius;
    for (const Vector3& other : grain->position) {
      free = free && (x - other).norm() > 0.8;
    }
    failures = free ? 0 : failures + 1;
    if (free) {
      grain->position.push_back(x);
    }
  }
  for (int i = 0; i < grain->n_nodes(); ++i) {
    for (int j = i + 1; j < grain->n_nodes(); ++j) {
      const double r = (grain->position[i] - grain->position[j]).norm();
      if (r < 1.5) {
        grain->bonds.push_back({i, j, r});
      }
    }
  }
  return grain;
}

Packing small_packing(const SmallPackingSpec& spec) {
  Uniform uniform(spec.seed);
  std::vector<Placement> placements;
  for (int tries = 0; static_cast<int>(placements.size()) < spec.n_grains; ++tries) {
    if (tries > 100000) {
      throw std::runtime_error("small_packing: no room");
    }
    Placement placement;
    placement.grain.alpha = spec.alpha;
    placement.centre = spec.box.to_position({uniform(0, 1), uniform(0, 1), uniform(0, 1)});
    bool free = true;
    for (const Placement& other : placements) {
      free = free && spec.box.minimum_image(placement.centre - other.centre).norm() > spec.least_distance;
    }
    if (free) {
      // One by one: in what order a call's arguments are computed is the compiler's choice.
      const double z = uniform(-1, 1), y = uniform(-1, 1), x = uniform(-1, 1), w = uniform(-1, 1);
      placement.rotation = Eigen::Quaterniond(w, x, y, z).normalized();
      placements.push_back(placement);
    }
  }
  Packing packing = make_packing(spec.box, {small_ball(spec.radius, spec.seed)}, placements);
  for (std::size_t i = 0; i < packing.position.size(); ++i) {
    packing.position[i] += uniform.in_cube(spec.jitter);
    packing.velocity[i] = uniform.in_cube(spec.speed);
  }
  return packing;
}

Topology small_topology() {
  Topology topology;
  topology.first_node = {0, 3, 5};
  topology.id = {11, 7, 3, 8, 2};
  topology.molecule = {4, 9};
  topology.species = {1, 0};
  topology.alpha = {2.0, -0.8};
  topology.template_index = {0, 1};
  topology.undeformed = {{{0.0, 0.0, 0.0}, {1.01, 0.0, 0.0}, {1.01, 0.97, 0.0}}, {}}; // the second is not known
  topology.bonds = {{0, 1, 1.01}, {1, 2, 0.97}, {3, 4, 1.3}};
  return topology;
}

Snapshot small_snapshot(std::int64_t step) {
  const double s = static_cast<double>(step);
  Snapshot snapshot;
  snapshot.step = step;
  snapshot.time = 0.1 * s;
  snapshot.strain = 0.001 * s;
  snapshot.streaming_rate = 0.002 * s;
  snapshot.box = Box(Vector3(0.5, -2, 1), Vector3(10 + 0.1 * s, 9, 8), Vector3(2.5, -1.5, 0.75));
  for (int i = 0; i < 5; ++i) {
    snapshot.position.emplace_back(1.7 * i + 0.01 * s, 3.0 * i - 20.0, 0.5 - 2.0 * i);
    snapshot.velocity.emplace_back(i, 0.1 * s, -i);
    snapshot.force.emplace_back(0.25 * i, s, 1.0);
  }
  const std::vector<Vector3>& x = snapshot.position;
  snapshot.grain_centre = {(x[0] + x[1] + x[2]) / 3.0, (x[3] + x[4]) / 2.0};
  snapshot.grain_stress = {{1, 2, 3, 4, 5, s}, {-1, -2, -3, -4, -5, -s}};
  return snapshot;
}

} // namespace boba::test
