// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/wall.h"

#include <vector>

namespace boba {

/// The walls of a packing. Whoever drives them sets, moves and stops them; an evaluation tells each its force.
class Walls {
public:
  void set(std::vector<Wall> walls) { walls_ = std::move(walls); }
  /// Moves every wall with its velocity for a time dt, tau.
  void advance(double dt) {
    for (Wall& wall : walls_) {
      wall.point += dt * wall.velocity;
    }
  }
  /// The walls stay where they are, at rest.
  void stop() {
    for (Wall& wall : walls_) {
      wall.velocity.setZero();
    }
  }
  /// Force of the material on a wall, against its normal, k d.
  void set_force(std::size_t wall, double force) { walls_[wall].force = force; }

  bool empty() const { return walls_.empty(); }
  std::size_t size() const { return walls_.size(); }
  const Wall& operator[](std::size_t wall) const { return walls_[wall]; }
  std::vector<Wall>::const_iterator begin() const { return walls_.begin(); }
  std::vector<Wall>::const_iterator end() const { return walls_.end(); }

private:
  std::vector<Wall> walls_;
};

} // namespace boba
