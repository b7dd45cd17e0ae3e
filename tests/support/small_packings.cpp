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
      placement.rotation = Eigen::Quaterniond(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
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

} // namespace boba::test
