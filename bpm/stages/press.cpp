// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/press.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

void PressDriver::begin(Stepper& stepper) {
  dt_ = stepper.options().dt;
  stage_.ends == PressStage::Ends::walls ? begin_walls(stepper) : begin_clamps(stepper);
  steps_.begin(stage_.strain * height_ / (2.0 * std::abs(stage_.velocity)), dt_);
}

void PressDriver::begin_walls(Stepper& stepper) {
  const std::array<double, 2> z = stepper.extent_z();
  const double reach = 0.5 * stepper.node_diameter(); // where a wall begins to feel a node
  const Vector3 up = Vector3::UnitZ();
  stepper.forces().walls() = {{(z[0] - reach) * up, up, stage_.velocity * up},
                              {(z[1] + reach) * up, -up, -stage_.velocity * up}};
  height_ = z[1] - z[0] + 2.0 * reach;
}

void PressDriver::begin_clamps(Stepper& stepper) {
  const std::array<double, 2> z = stepper.extent_z();
  height_ = z[1] - z[0] - 2.0 * stage_.clamp_thickness;
  if (!(height_ > 0.0)) {
    throw std::runtime_error(
        fmt::format("press: clamp_thickness = {} d leaves nothing between the ends of a specimen of height "
                    "{:.4g} d; it must be below half of that",
                    stage_.clamp_thickness, z[1] - z[0]));
  }
  stepper.set_clamps({stepper.nodes_between(z[0], z[0] + stage_.clamp_thickness),
                      stepper.nodes_between(z[1] - stage_.clamp_thickness, z[1])});
  stepper.clamps()[0].velocity = stage_.velocity * Vector3::UnitZ();
  stepper.clamps()[1].velocity = -stage_.velocity * Vector3::UnitZ();
}

double PressDriver::moved() const {
  return static_cast<double>(steps_.done()) * dt_ * stage_.velocity;
}

CellRates PressDriver::update(Stepper& stepper) {
  steps_.count();
  for (Wall& wall : stepper.forces().walls()) {
    wall.point += dt_ * wall.velocity;
  }
  stepper.set_end_gap(height_ - 2.0 * moved());
  return {};
}

void PressDriver::end(Stepper& stepper) {
  // The ends stay where they are, at rest, for a stage that follows.
  for (Wall& wall : stepper.forces().walls()) {
    wall.velocity.setZero();
  }
  for (Clamp& clamp : stepper.clamps()) {
    clamp.velocity.setZero();
  }
}

StageProgress PressDriver::progress(const Stepper&) const {
  StageProgress progress;
  progress.done = steps_.share_done();
  progress.driven = "strain";
  progress.target = stage_.strain;
  progress.value = height_ > 0.0 ? 2.0 * std::abs(moved()) / height_ : 0.0;
  return progress;
}

void PressDriver::save(SavedState& saved) const {
  saved.real["driver"] = {height_, dt_};
  steps_.save(saved);
}

void PressDriver::restore(const SavedState& saved) {
  height_ = saved.real.at("driver").at(0);
  dt_ = saved.real.at("driver").at(1);
  steps_.restore(saved);
}

} // namespace boba
