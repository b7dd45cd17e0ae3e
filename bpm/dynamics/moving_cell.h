// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/remap.h"
#include "bpm/packing/box.h"

namespace boba {

/// How the cell moves at the end of a step.
struct CellRates {
  double shear = 0.0; ///< d(xy)/dt over the current Ly, 1/tau
  Remap remap = Remap::positions;
  double dilation = 0.0; ///< d ln L / dt of all three axes, 1/tau; always acts on positions
  /// Any velocity gradient beside these (upper triangular, 1/tau). Its diagonal acts on positions.
  Matrix3 gradient = Matrix3::Zero();
  double strain_rate = 0.0; ///< what the gradient adds to the strain that outputs count, 1/tau
};

/// The periodic cell and its motion. The box moves at the end of a step; the nodes follow with the next drift, by a map
/// of their positions or by a linear profile of their velocities (streaming).
class MovingCell {
public:
  explicit MovingCell(const Box& box) : box_(box), evaluated_box_(box) {}

  /// Moves the box by a velocity gradient (upper triangular, 1/tau) for a time dt (tau). The part `of_positions` of it
  /// is to act on the nodes; the rest moves images. The box is flipped when it leans too far and `may_flip` is true.
  /// Returns whether it was flipped.
  bool deform(const Matrix3& gradient, const Matrix3& of_positions, double dt, bool may_flip);
  /// The distance of the faces across z, along which the cell is open: what volumes and stresses refer to, d.
  void set_height(double height);
  /// The nodes' velocities hold this profile already; images move with it. For states that come like that.
  void assume_streaming(const Matrix3& gradient);
  void add_strain(double strain) { strain_ += strain; }
  /// The nodes have followed the box.
  void note_drift();
  /// Forces were evaluated in the box as it is.
  void note_evaluation() { evaluated_box_ = box_; }

  const Box& box() const { return box_; }
  double strain() const { return strain_; }
  /// Of the whole cell, at the end of the last step.
  const Matrix3& map() const { return map_; }
  /// The part of it that acts on positions and that the next drift applies: x -> position_map x + position_shift.
  const Matrix3& position_map() const { return position_map_; }
  Vector3 position_shift() const { return box_.origin() - position_map_ * box_.origin(); }
  /// The rest, as a rate of the cell matrix, d/tau: images move with it, and velocities hold it from the next drift on.
  const Matrix3& residual_rate() const { return residual_rate_; }
  /// The velocity gradient of the linear profile that the nodes' velocities hold, 1/tau.
  const Matrix3& streaming() const { return streaming_; }
  /// The same from the next drift on.
  const Matrix3& next_streaming() const { return next_streaming_; }
  /// The profile that the next drift adds to the velocities at the nodes' present positions: what it takes to hold the
  /// next profile where the nodes will have been mapped to.
  Matrix3 streaming_change() const { return next_streaming_ * position_map_ - streaming_; }
  /// The box that the last forces belong to.
  const Box& evaluated_box() const { return evaluated_box_; }

  /// All of the above but the origin, as a checkpoint keeps it.
  struct Saved {
    Matrix3 h, evaluated_h, map, position_map, residual_rate, streaming, next_streaming;
    double strain;
  };
  Saved saved() const;
  void restore(const Saved& saved);

private:
  Box box_, evaluated_box_;
  Matrix3 map_ = Matrix3::Identity(), position_map_ = Matrix3::Identity();
  Matrix3 residual_rate_ = Matrix3::Zero();
  Matrix3 streaming_ = Matrix3::Zero(), next_streaming_ = Matrix3::Zero();
  double strain_ = 0.0;
};

/// The velocity gradient of a simple shear in x along y, 1/tau.
Matrix3 simple_shear(double rate);

} // namespace boba
