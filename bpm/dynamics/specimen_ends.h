// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/clamp.h"
#include "bpm/forces/walls.h"

#include <array>
#include <vector>

namespace boba {

struct MovingPacking;

/// What holds a specimen or a packing at its lower and its upper end: two walls or two clamps, which move along z; and
/// walls at its sides, which stand still.
class SpecimenEnds {
public:
  explicit SpecimenEnds(Walls& walls) : walls_(walls) {}

  /// Walls at rest at the faces of the cell across some axes; those across z are the ends. None where no axis has any.
  void set_faces(const Box& box, const std::array<bool, 3>& across);
  /// Two walls across z (lower, upper; d) that move towards each other with `velocity` each (d/tau).
  void set_walls(const std::array<double, 2>& z, double velocity);
  /// The walls that are the ends move towards each other, from where they are, with `velocity` each (d/tau).
  void drive_walls(double velocity);
  /// True when two walls are the ends; their distance, d.
  bool has_walls() const { return walls_.size() >= 2; }
  double wall_distance() const { return walls_[1].point.z() - walls_[0].point.z(); }
  /// Two clamps (lower, upper) that move towards each other with `velocity` each (d/tau).
  void set_clamps(std::vector<Clamp> clamps, double velocity);
  /// Moves the walls on by a time dt; clamped nodes move with their velocities.
  void advance(double dt) { walls_.advance(dt); }
  /// The ends stay where they are, at rest.
  void stop();

  bool has_clamps() const { return !clamps_.empty(); }
  bool are_free() const { return walls_.empty() && clamps_.empty(); }
  std::vector<Clamp>& clamps() { return clamps_; }
  const std::vector<Clamp>& clamps() const { return clamps_; }
  const Walls& walls() const { return walls_; }
  Walls& walls() { return walls_; }
  /// Force of the material on the lower and the upper end, positive when it pushes them apart, k d.
  std::array<double, 2> forces() const;
  /// Distance between the two ends, d; 0 when there are none.
  double gap() const { return gap_; }
  void set_gap(double gap) { gap_ = gap; }

private:
  Walls& walls_;
  std::vector<Clamp> clamps_;
  double gap_ = 0.0;
};

/// Smallest and largest z of any node, d. Collective.
std::array<double, 2> extent_z(const MovingPacking& moving);

/// All nodes with z in [low, high] (d) as a clamp at rest. Collective.
Clamp nodes_between(const MovingPacking& moving, double low, double high);

} // namespace boba
