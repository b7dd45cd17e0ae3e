// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/press.h"

#include "bpm/dynamics/stepper.h"
#include "bpm/laws/hertz.h"
#include "bpm/toml/schema.h"

#include <algorithm>
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
  if (stepper.ends().has_walls()) {
    stepper.ends().drive_walls(stage_.velocity);
    height_ = stepper.ends().wall_distance();
    return;
  }
  const std::array<double, 2> z = extent_z(stepper.moving());
  const double reach = 0.5 * stepper.contact_range(); // where a wall begins to feel a node
  stepper.ends().set_walls({z[0] - reach, z[1] + reach}, stage_.velocity);
  height_ = z[1] - z[0] + 2.0 * reach;
}

void PressDriver::begin_clamps(Stepper& stepper) {
  const std::array<double, 2> z = extent_z(stepper.moving());
  height_ = z[1] - z[0] - 2.0 * stage_.clamp_thickness;
  if (!(height_ > 0.0)) {
    throw std::runtime_error(
        fmt::format("press: clamp_thickness = {} d leaves nothing between the ends of a specimen of height "
                    "{:.4g} d; it must be below half of that",
                    stage_.clamp_thickness, z[1] - z[0]));
  }
  stepper.ends().set_clamps({nodes_between(stepper.moving(), z[0], z[0] + stage_.clamp_thickness),
                             nodes_between(stepper.moving(), z[1] - stage_.clamp_thickness, z[1])},
                            stage_.velocity);
}

double PressDriver::moved() const {
  return static_cast<double>(steps_.done()) * dt_ * stage_.velocity;
}

CellRates PressDriver::update(Stepper& stepper) {
  steps_.count();
  stepper.ends().advance(dt_);
  stepper.ends().set_gap(height_ - 2.0 * moved());
  if (stepper.moving().packing.walls[2]) { // the cell ends at the walls
    stepper.moving().cell.set_height(height_ - 2.0 * moved());
  }
  return {};
}

void PressDriver::end(Stepper& stepper) {
  stepper.ends().stop(); // for a stage that follows
}

StageProgress PressDriver::progress(const Stepper&) const {
  StageProgress progress;
  progress.done = steps_.share_done();
  progress.driven = "strain";
  progress.target = stage_.strain;
  progress.value = height_ > 0.0 ? 2.0 * std::abs(moved()) / height_ : 0.0;
  return progress;
}

void PressDriver::archive(Archive& archive) {
  archive.field("height", height_);
  archive.field("dt", dt_);
  archive.object("steps", steps_);
}

SceneSection PressEntry::section() {
  return {
      "stage",
      "press",
      true,
      "Squeezes a specimen, or a packing that was placed between walls, along z between two walls or two clamped ends. "
      "Walls that stand already, of `insert` or of a stage before, move on from where they are.",
      {required(above_key("strain", "", 0.0, 0.9, "",
                          "displacement of both ends together over their distance at the start")),
       choice_key("ends", {"walls", "clamps"}, "\"walls\"", "rigid walls, or end layers that move rigidly"),
       real_key("velocity", "d/tau", -0.1, 0.1, "1e-3",
                "of each end, not 0; negative pulls clamps, or moves walls back"),
       above_key("clamp_thickness", "d", 0.0, 1e3, "2", "nodes within this distance of an end are clamped")}};
}

PressEntry::PressEntry(const SceneTable& table) {
  parameters_.strain = table.real("strain", 0.0);
  parameters_.ends = table.text("ends", "walls") == "walls" ? PressStage::Ends::walls : PressStage::Ends::clamps;
  parameters_.velocity = table.real("velocity", parameters_.velocity);
  parameters_.clamp_thickness = table.real("clamp_thickness", parameters_.clamp_thickness);
  if (parameters_.velocity == 0.0) {
    table.fail("velocity", "must not be 0");
  }
  if (parameters_.ends == PressStage::Ends::walls && table.has("clamp_thickness")) {
    table.fail("clamp_thickness", "needs ends = \"clamps\"");
  }
}

void PressEntry::check(const SceneTable& table, const StageSurroundings& surroundings) const {
  require_open_cell(table, surroundings);
  if (surroundings.material.contact == HertzLaw::name) {
    table.fail("type", "has no meaning with material.hertz_modulus: Hertz's law is for contacts of two spheres, not "
                       "for walls and clamps");
  }
  // A specimen has a height of at least 2 d. That of a higher one is known when the stage begins.
  require_countable_steps(table, "velocity", parameters_.strain / std::abs(parameters_.velocity), surroundings.dt);
}

StageLength PressEntry::estimate(const StageContext& context) const {
  const std::vector<Vector3>& x = context.packing.position;
  const auto [low, high] =
      std::minmax_element(x.begin(), x.end(), [](const Vector3& a, const Vector3& b) { return a.z() < b.z(); });
  return {.time = parameters_.strain * (high->z() - low->z()) / (2.0 * std::abs(parameters_.velocity))};
}

std::unique_ptr<StageDriver> PressEntry::make_driver(const StageContext&) const {
  return std::make_unique<PressDriver>(parameters_);
}

} // namespace boba
