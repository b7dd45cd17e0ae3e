// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/relax.h"

#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace boba {

using Kind = ComponentDrive::Kind;

RelaxDriver::RelaxDriver(const RelaxStage& stage) : stage_(stage), rest_(stage.rest), cell_(stage.cell) {
  moves_cell_ =
      std::ranges::any_of(stage_.cell.component, [](const ComponentDrive& drive) { return drive.kind != Kind::fixed; });
}

void RelaxDriver::begin(Stepper& stepper) {
  first_step_ = last_step_ = stepper.step();
  rest_.begin(stepper, name());
  if (moves_cell_) {
    cell_.begin(stepper);
  }
}

bool RelaxDriver::stresses_hold(const Stepper& stepper) const {
  const std::array<double, 6> stress = stress_of(stepper.moving());
  double largest = 0.0;
  for (const double s : stress) {
    largest = std::max(largest, std::abs(s));
  }
  for (int c = 0; c < 6; ++c) {
    const ComponentDrive& drive = stage_.cell.component[c];
    if (drive.kind == Kind::stress) {
      const double scale = drive.stress == 0.0 ? largest : std::abs(drive.stress);
      if (std::abs(stress[c] - drive.stress) > stage_.stress_tolerance * scale) {
        return false;
      }
    }
  }
  const auto& pressure = stage_.cell.pressure;
  return !pressure || std::abs(stepper.pressure() / pressure->pressure - 1.0) <= stage_.stress_tolerance;
}

CellRates RelaxDriver::update(Stepper& stepper) {
  last_step_ = stepper.step();
  const CellRates rates = moves_cell_ ? cell_.update(stepper) : CellRates();
  is_at_rest_ = rest_.look(stepper, !moves_cell_ || stresses_hold(stepper));
  return is_at_rest_ || rest_.is_checking() ? CellRates() : rates;
}

StageProgress RelaxDriver::progress(const Stepper&) const {
  StageProgress progress;
  progress.driven = "net force";
  progress.value = rest_.largest_force();
  progress.target = stage_.rest.force_tolerance;
  // Forces fall by orders of magnitude: their logarithm tells best.
  const double orders = -std::log10(std::max(rest_.largest_force(), stage_.rest.force_tolerance));
  progress.done = is_at_rest_ ? 1.0 : std::clamp(orders / -std::log10(stage_.rest.force_tolerance), 0.0, 0.99);
  return progress;
}

std::string RelaxDriver::report() const {
  return fmt::format("at rest after {} steps: no net force on a node is larger than {:.2g} k d (allowed {:g})",
                     last_step_ - first_step_, rest_.largest_force(), stage_.rest.force_tolerance);
}

void RelaxDriver::archive(Archive& archive) {
  archive.object("rest", rest_);
  archive.object("cell", cell_);
  archive.field("is_at_rest", is_at_rest_);
  archive.field("first_step", first_step_);
  archive.field("last_step", last_step_);
}

SceneSection RelaxEntry::section() {
  std::vector<SceneKey> keys = rest_keys();
  for (const std::string c : cell_components) {
    keys.push_back(real_key(c + "_stress", "k/d", -100.0, 100.0, "",
                            "stress to hold, tension positive; without it the component is fixed"));
  }
  keys.push_back(above_key("stress_tolerance", "", 0.0, 1.0, "1e-4",
                           "|sigma / target - 1| at the end; for a target of 0 |sigma| over the largest stress"));
  return {"stage", "relax", true,
          "Brings the packing to rest, in a fixed cell or at held stresses; the run fails where it does not settle.",
          joined(std::move(keys), pressure_keys(" by all three lengths alike; without one the cell is fixed"))};
}

RelaxEntry::RelaxEntry(const SceneTable& table) : pressure_(table, true) {
  stage_.rest = read_rest_plan(table);
  stage_.stress_tolerance = table.real("stress_tolerance", stage_.stress_tolerance);
  stage_.cell.kind = "relax";
  stage_.cell.time = 2.0 * stage_.rest.max_time;
  stage_.cell.servo = {0.0, table.maybe_real("gain"), table.real("rate_cap", Barostat().rate_cap)};
  for (int c = 0; c < 6; ++c) {
    if (const auto stress = table.maybe_real(std::string(cell_components[c]) + "_stress")) {
      stage_.cell.component[c].kind = Kind::stress;
      stage_.cell.component[c].stress = *stress;
      moves_cell_ = true;
    }
  }
  if (pressure_.is_given() && moves_cell_) {
    table.fail("pressure", "is given together with a stress; give one kind");
  }
  for (int c = 0; c < 3 && pressure_.is_given(); ++c) {
    stage_.cell.component[c].kind = Kind::pressure;
  }
  moves_cell_ = moves_cell_ || pressure_.is_given();
  for (const char* key : {"gain", "rate_cap", "stress_tolerance"}) {
    if (!moves_cell_ && table.has(key)) {
      table.fail(key, "needs a pressure or a stress to hold");
    }
  }
}

void RelaxEntry::check(const SceneTable& table, const StageSurroundings& surroundings) const {
  if (moves_cell_) {
    require_periodic_cell(table, surroundings);
  }
  require_countable_steps(table, "max_time", stage_.cell.time, surroundings.dt);
}

StageLength RelaxEntry::estimate(const StageContext&) const {
  return {.time = std::min(300.0, stage_.rest.max_time), .is_exact = false};
}

std::unique_ptr<StageDriver> RelaxEntry::make_driver(const StageContext& context) const {
  RelaxStage stage = stage_;
  stage.cell.pressure = pressure_.barostat(context);
  return std::make_unique<RelaxDriver>(stage);
}

} // namespace boba
