// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/moving_cell.h"

namespace boba {

bool MovingCell::deform(const Matrix3& gradient, const Matrix3& of_positions, double dt, bool may_flip) {
  bool flipped = false;
  if (gradient != Matrix3::Zero()) {
    map_ = Matrix3::Identity() + dt * gradient;
    position_map_ = Matrix3::Identity() + dt * of_positions;
    box_.set_h(map_ * box_.h());
    flipped = may_flip && box_.flip();
  }
  next_streaming_ = gradient - of_positions;
  residual_rate_ = next_streaming_ * box_.h();
  return flipped;
}

void MovingCell::set_height(double height) {
  Matrix3 h = box_.h();
  h(2, 2) = height;
  box_.set_h(h);
}

void MovingCell::assume_streaming(const Matrix3& gradient) {
  streaming_ = gradient;
  next_streaming_ = gradient;
  residual_rate_ = gradient * box_.h();
}

void MovingCell::note_drift() {
  streaming_ = next_streaming_;
  map_.setIdentity();
  position_map_.setIdentity();
}

MovingCell::Saved MovingCell::saved() const {
  return {box_.h(), evaluated_box_.h(), map_, position_map_, residual_rate_, streaming_, next_streaming_, strain_};
}

void MovingCell::restore(const Saved& saved) {
  box_.set_h(saved.h);
  evaluated_box_.set_h(saved.evaluated_h);
  map_ = saved.map;
  position_map_ = saved.position_map;
  residual_rate_ = saved.residual_rate;
  streaming_ = saved.streaming;
  next_streaming_ = saved.next_streaming;
  strain_ = saved.strain;
}

Matrix3 simple_shear(double rate) {
  Matrix3 gradient = Matrix3::Zero();
  gradient(0, 1) = rate;
  return gradient;
}

} // namespace boba
