// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/specimen_ends.h"

#include "bpm/dynamics/moving_packing.h"

#include <algorithm>

namespace boba {

void SpecimenEnds::set_walls(const std::array<double, 2>& z, double velocity) {
  const Vector3 up = Vector3::UnitZ();
  walls_.set({{z[0] * up, up, velocity * up}, {z[1] * up, -up, -velocity * up}});
}

void SpecimenEnds::set_faces(const Box& box, const std::array<bool, 3>& across) {
  std::vector<Wall> walls;
  for (const int axis : {2, 0, 1}) { // the ends first
    if (across[axis]) {
      const Vector3 inwards = Vector3::Unit(axis);
      walls.push_back({box.origin(), inwards, Vector3::Zero()});
      walls.push_back({box.origin() + box.lengths()[axis] * inwards, -inwards, Vector3::Zero()});
    }
  }
  if (!walls.empty()) {
    walls_.set(std::move(walls));
    gap_ = across[2] ? box.lengths()[2] : 0.0;
  }
}

void SpecimenEnds::drive_walls(double velocity) {
  std::vector<Wall> walls(walls_.begin(), walls_.end());
  walls[0].velocity = velocity * Vector3::UnitZ();
  walls[1].velocity = -velocity * Vector3::UnitZ();
  walls_.set(std::move(walls));
}

void SpecimenEnds::set_clamps(std::vector<Clamp> clamps, double velocity) {
  clamps_ = std::move(clamps);
  clamps_[0].velocity = velocity * Vector3::UnitZ();
  clamps_[1].velocity = -velocity * Vector3::UnitZ();
}

void SpecimenEnds::stop() {
  walls_.stop();
  for (Clamp& clamp : clamps_) {
    clamp.velocity.setZero();
  }
}

std::array<double, 2> SpecimenEnds::forces() const {
  if (clamps_.size() == 2) {
    return {-clamps_[0].force[2], clamps_[1].force[2]};
  }
  if (has_walls()) {
    return {walls_[0].force, walls_[1].force};
  }
  return {0.0, 0.0};
}

std::array<double, 2> extent_z(const MovingPacking& moving) {
  std::array<double, 2> extent = {1e300, -1e300};
  for (const int g : moving.layout.grains()) {
    for (int node = 0; node < moving.layout.n_nodes(g); ++node) {
      const double z = moving.state.position(g, node)[2];
      extent = {std::min(extent[0], z), std::max(extent[1], z)};
    }
  }
  return {moving.ranks().smallest(extent[0]), moving.ranks().largest(extent[1])};
}

Clamp nodes_between(const MovingPacking& moving, double low, double high) {
  Clamp clamp = clamp_between(low, high, moving.layout, moving.state);
  share_clamp(clamp, moving.distribution, moving.layout.n_grains());
  return clamp;
}

} // namespace boba
