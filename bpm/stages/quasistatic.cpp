// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/quasistatic.h"

#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace boba {

using Kind = ComponentDrive::Kind;

QuasistaticDriver::QuasistaticDriver(const QuasistaticStage& stage)
    : stage_(stage), rest_(stage.rest), cell_(stage.cell) {
  table_.columns = {"strain",        "stress_xx_k/d", "stress_yy_k/d", "stress_zz_k/d", "stress_xy_k/d",
                    "stress_xz_k/d", "stress_yz_k/d", "volume_d3",     "modulus_k/d",   "largest_net_force_kd"};
}

void QuasistaticDriver::begin(Stepper& stepper) {
  // The cell's driver counts steps of strain: one of its steps is taken for each.
  stage_.cell.time = static_cast<double>(stage_.steps) * stepper.options().dt;
  ComponentDrive& drive = stage_.cell.component[stage_.component];
  drive.path.duration = stage_.cell.time;
  drive.path.rate_from = drive.path.rate = drive.path.amplitude / stage_.cell.time;
  cell_ = DeformDriver(stage_.cell);
  cell_.begin(stepper);
  rest_.begin(stepper, name());
}

CellRates QuasistaticDriver::update(Stepper& stepper) {
  if (moves_next_) {
    moves_next_ = false;
    ++steps_done_;
    rest_.begin(stepper, name());
    return cell_.update(stepper);
  }
  if (rest_.look(stepper, true)) {
    note_rest(stepper);
    is_over_ = steps_done_ == stage_.steps;
    moves_next_ = !is_over_;
  }
  return {};
}

void QuasistaticDriver::note_rest(const Stepper& stepper) {
  const double step = stage_.cell.component[stage_.component].path.amplitude / static_cast<double>(stage_.steps);
  const std::array<double, 6> stress = stress_of(stepper.moving());
  StageTable::Row row{stepper.step(), {step * static_cast<double>(steps_done_)}};
  row.values.insert(row.values.end(), stress.begin(), stress.end());
  row.values.push_back(stepper.moving().cell.evaluated_box().volume());
  row.values.push_back(table_.rows.empty()
                           ? std::numeric_limits<double>::quiet_NaN()
                           : (stress[stage_.component] - table_.rows.back().values[1 + stage_.component]) / step);
  row.values.push_back(rest_.largest_force());
  table_.rows.push_back(std::move(row));
}

StageProgress QuasistaticDriver::progress(const Stepper&) const {
  StageProgress progress;
  progress.driven = std::string(cell_components[stage_.component]) + " strain";
  progress.target = stage_.cell.component[stage_.component].path.amplitude;
  const double done = static_cast<double>(steps_done_) / static_cast<double>(stage_.steps);
  progress.value = done * progress.target;
  progress.done = done;
  return progress;
}

std::string QuasistaticDriver::report() const {
  if (table_.rows.size() < 2) {
    return "";
  }
  const double first = table_.rows[1].values[8], last = table_.rows.back().values[8];
  return fmt::format(
      "{} steps of strain {} at rest: modulus d sigma_{} / d strain {:.6g} k/d in the first step, {:.6g} in "
      "the last",
      stage_.steps, cell_components[stage_.component], cell_components[stage_.component], first, last);
}

void QuasistaticDriver::archive(Archive& archive) {
  if (archive.is_reading()) { // the rates of its path come with the time of a step
    double dt = 0.0;
    archive.inside("cell", [&] { archive.field("dt", dt); });
    stage_.cell.time = static_cast<double>(stage_.steps) * dt;
    ComponentDrive& drive = stage_.cell.component[stage_.component];
    drive.path.duration = stage_.cell.time;
    drive.path.rate_from = drive.path.rate = drive.path.amplitude / stage_.cell.time;
    cell_ = DeformDriver(stage_.cell);
  }
  archive.object("rest", rest_);
  archive.object("cell", cell_);
  archive.object("table", table_);
  archive.field("steps_done", steps_done_);
  archive.field("moves_next", moves_next_);
  archive.field("is_over", is_over_);
}

SceneSection QuasistaticEntry::section() {
  return {
      "stage", "quasistatic", true,
      "Strains one component in steps, each followed by a search for rest: stress and modulus without a rate, in "
      "stages/stage-N.csv.",
      joined({choice_key("component", {"xx", "yy", "zz", "xy", "xz", "yz"}, "\"xy\"", "of the cell, that is strained"),
              required(real_key("strain", "", -10.0, 10.0, "", "to reach; not 0")),
              integer_key("steps", 1.0, 1e6, "10", "in so many equal steps"),
              boolean_key("keep_volume", "false", "the other two lengths keep the volume (of a strain xx, yy or zz)")},
             rest_keys())};
}

QuasistaticEntry::QuasistaticEntry(const SceneTable& table) {
  stage_.rest = read_rest_plan(table);
  stage_.cell.kind = "quasistatic";
  stage_.steps = table.integer("steps", 10);
  const std::string component = table.text("component", "xy");
  for (int c = 0; c < 6; ++c) {
    stage_.component = cell_components[c] == component ? c : stage_.component;
  }
  ComponentDrive& drive = stage_.cell.component[stage_.component];
  drive.kind = Kind::strain;
  drive.path.amplitude = table.real("strain", 0.0);
  if (drive.path.amplitude == 0.0 || (stage_.component < 3 && drive.path.amplitude <= -1.0)) {
    table.fail("strain", "must not be 0, and above -1 for a length");
  }
  if (table.boolean("keep_volume", false)) {
    if (stage_.component > 2) {
      table.fail("keep_volume", "has no use: a tilt changes no volume");
    }
    for (int c = 0; c < 3; ++c) {
      stage_.cell.component[c].kind = c == stage_.component ? Kind::strain : Kind::volume;
    }
  }
}

void QuasistaticEntry::check(const SceneTable& table, const StageSurroundings& surroundings) const {
  require_periodic_cell(table, surroundings);
  require_countable_steps(table, "max_time", stage_.rest.max_time * static_cast<double>(stage_.steps), surroundings.dt);
}

StageLength QuasistaticEntry::estimate(const StageContext&) const {
  return {.time = 300.0 * static_cast<double>(stage_.steps + 1), .is_exact = false};
}

std::unique_ptr<StageDriver> QuasistaticEntry::make_driver(const StageContext&) const {
  return std::make_unique<QuasistaticDriver>(stage_);
}

} // namespace boba
