// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/deform_entry.h"

#include "bpm/io/input_error.h"
#include "bpm/toml/schema.h"

#include <cmath>
#include <fmt/format.h>

namespace boba {

namespace {

using Kind = ComponentDrive::Kind;

/// Of a strain that a scene prescribes, 1/tau: beyond it the cell turns over in a few steps.
constexpr double largest_rate = 0.1;

/// The keys of one component: each begins with its name.
std::vector<SceneKey> component_keys(const std::string& c) {
  const bool is_length = c[0] == c[1];
  const std::string what = is_length ? "length along " + c.substr(1) : "tilt " + c;
  return {
      real_key(c + "_rate", "1/tau", -largest_rate, largest_rate, "",
               "rate of strain of the " + what + ", at the stage's end"),
      real_key(c + "_rate_from", "1/tau", -largest_rate, largest_rate, "",
               "rate at its beginning; without it the same"),
      real_key(c + "_strain", "", -1e6, 1e6, "",
               "strain to reach at the end, at a constant rate; with " + c + "_rate it sets the stage's length"),
      real_key(c + "_amplitude", "", -10.0, 10.0, "", "of cycles of strain (period, cycles, wave); not 0"),
      real_key(c + "_stress", "k/d", -100.0, 100.0, "", "stress to hold, tension positive"),
      or_text(real_key(c + "_stress_from", "k/d", -100.0, 100.0, "",
                       "stress at the beginning; from there it goes linearly to " + c +
                           "_stress; \"present\": what it is then"),
              {"present"}),
      choice_key(
          c, is_length ? std::vector<std::string>{"fixed", "volume", "pressure"} : std::vector<std::string>{"fixed"},
          "\"fixed\"",
          is_length ? "without a key of those above: stays, keeps the volume, or dilates with the others of its "
                      "kind to hold the pressure"
                    : "without a key of those above: stays"),
  };
}

std::vector<SceneKey> deform_keys() {
  std::vector<SceneKey> keys = {
      above_key("time", "tau", 0.0, 1e12, "",
                "how long; required unless a component has a rate and a strain, or cycles"),
      above_key("period", "tau", 0.0, 1e12, "", "of one cycle"),
      above_key("cycles", "", 0.0, 1e9, "1", "how many"),
      choice_key("wave", {"sine", "triangle"}, "\"sine\"", "shape of the cycles"),
      choice_key("remap", {"positions", "velocities"}, "\"positions\"",
                 "how a shear xy acts: nodes follow the cell affinely, or only images across the cell carry its "
                 "velocity; other components act on positions"),
      above_key("pressure", "k/d", 0.0, 100.0, "", "of the lengths that hold it"),
  };
  for (const char* c : cell_components) {
    keys = joined(std::move(keys), component_keys(c));
  }
  return joined(joined(std::move(keys), {measure_key(), normalised_key()}), servo_keys());
}

} // namespace

SceneKey measure_key() {
  return choice_key("measure", {"engineering", "logarithmic"}, "\"engineering\"",
                    "what strains and rates refer to: the cell at the stage's beginning, or as it is");
}

SceneKey normalised_key() {
  return boolean_key("normalised", "false", "stresses and pressures of this stage are multiples of E / (2 - 2 nu^2)");
}

std::vector<SceneKey> servo_keys() {
  return {
      above_key("gain", "d/(k tau)", 0.0, 10.0, "",
                "gain g of the servos, de/dt = g (target - sigma); default 1 / (C t_c), see docs/notation.md"),
      above_key("rate_cap", "1/tau", 0.0, 0.1, "1e-3", "largest rate of strain of a servo"),
  };
}

LoadingEntry::LoadingEntry(const SceneTable& table)
    : normalised_(table.boolean("normalised", false)), table_(table.name()) {
  stage_.kind = table.kind();
  stage_.measure =
      table.text("measure", "engineering") == "engineering" ? StrainMeasure::engineering : StrainMeasure::logarithmic;
  stage_.servo = {0.0, table.maybe_real("gain"), table.real("rate_cap", Barostat().rate_cap)};
}

void LoadingEntry::set_time(const SceneTable& table, double time) {
  stage_.time = time;
  bool is_driven = false;
  for (ComponentDrive& drive : stage_.component) {
    drive.path.duration = time;
    is_driven = is_driven || drive.kind != Kind::fixed;
  }
  if (!is_driven) {
    table.fail("type", "drives no component of the cell; for a cell at rest take a \"hold\" stage");
  }
}

void LoadingEntry::check(const SceneTable& table, const StageSurroundings& surroundings) const {
  require_periodic_cell(table, surroundings);
  require_countable_steps(table, "type", stage_.time, surroundings.dt);
  for (int c = 0; c < 3; ++c) {
    const ComponentDrive& drive = stage_.component[c];
    if (drive.kind == Kind::strain && stage_.measure == StrainMeasure::engineering && drive.path.smallest() <= -1.0) {
      table.fail("type", fmt::format("takes the length along {} to a strain of {:g}, where nothing is left of it; "
                                     "engineering strains are above -1",
                                     "xyz"[c], drive.path.smallest()));
    }
  }
}

bool LoadingEntry::has_table() const {
  return DeformDriver(stage_).table() != nullptr;
}

StageLength LoadingEntry::estimate(const StageContext&) const {
  return {.time = stage_.time};
}

std::unique_ptr<StageDriver> LoadingEntry::make_driver(const StageContext& context) const {
  DeformStage stage = stage_;
  if (normalised_) {
    if (!context.numbers.modulus) {
      throw InputError(fmt::format("{}: {}.normalised = true: E and nu are unknown, because an alpha of the packing "
                                   "lies outside the installed table; give stresses in k/d instead",
                                   context.scene, table_));
    }
    const double unit = *context.numbers.modulus;
    for (ComponentDrive& drive : stage.component) {
      drive.stress *= unit;
      drive.stress_from = drive.stress_from ? std::optional(unit * *drive.stress_from) : std::nullopt;
    }
    if (stage.pressure) {
      stage.pressure->pressure *= unit;
    }
  }
  return std::make_unique<DeformDriver>(stage);
}

SceneSection DeformEntry::section() {
  return {
      "stage", "deform", true,
      "Deforms the periodic cell, each component in its own way: along a strain, at a held stress, so that the volume "
      "or the pressure is kept, or not at all.",
      deform_keys()};
}

DeformEntry::DeformEntry(const SceneTable& table) : LoadingEntry(table) {
  stage_.remap = table.text("remap", "positions") == "positions" ? Remap::positions : Remap::velocities;
  for (int c = 0; c < 6; ++c) {
    read_component(table, c);
    if (stage_.remap == Remap::velocities && c > 3 && stage_.component[c].kind != Kind::fixed) {
      table.fail("remap", fmt::format("= \"velocities\" is for a shear xy; {} is driven too", cell_components[c]));
    }
  }
  bool holds = false;
  for (const ComponentDrive& drive : stage_.component) {
    holds = holds || drive.kind == Kind::pressure;
  }
  if (holds != table.has("pressure")) {
    table.fail("pressure", holds ? "must be given: a length is to hold it" : "needs a length with = \"pressure\"");
  }
  if (holds) {
    stage_.pressure = Barostat{table.real("pressure", 0.0), stage_.servo.gain, stage_.servo.rate_cap};
  }
  set_time(table, read_time(table));
  for (ComponentDrive& drive : stage_.component) { // a strain to reach, without a rate
    if (drive.kind == Kind::strain && drive.path.kind == PrescribedStrain::Kind::ramp && std::isnan(drive.path.rate)) {
      drive.path.rate_from = drive.path.rate = drive.path.amplitude / stage_.time;
    }
  }
  check_rates(table);
}

void DeformEntry::check_rates(const SceneTable& table) const {
  for (int c = 0; c < 6; ++c) {
    const ComponentDrive& drive = stage_.component[c];
    if (drive.kind == Kind::strain && drive.path.fastest() > largest_rate) {
      const std::string key =
          cell_components[c] + std::string(drive.path.kind == PrescribedStrain::Kind::ramp ? "_strain" : "_amplitude");
      table.fail(key, fmt::format("takes a rate of {:g} 1/tau in {:g} tau; at most {:g} is allowed",
                                  drive.path.fastest(), stage_.time, largest_rate));
    }
  }
}

void DeformEntry::read_component(const SceneTable& table, int component) {
  const std::string c = cell_components[component];
  ComponentDrive& drive = stage_.component[component];
  const bool has_rate = table.has(c + "_rate"), has_strain = table.has(c + "_strain");
  const bool is_cyclic = table.has(c + "_amplitude"), has_stress = table.has(c + "_stress");
  if ((has_rate || has_strain ? 1 : 0) + (is_cyclic ? 1 : 0) + (has_stress ? 1 : 0) + (table.has(c) ? 1 : 0) > 1) {
    table.fail(table.has(c) ? c
               : has_stress ? c + "_stress"
                            : c + "_amplitude",
               "is one of several ways to drive " + c + "; give one");
  }
  if (table.has(c + "_rate_from") && (!has_rate || has_strain)) {
    table.fail(c + "_rate_from", "needs " + c + "_rate, without " + c + "_strain");
  }
  if (table.has(c + "_stress_from") && !has_stress) {
    table.fail(c + "_stress_from", "needs " + c + "_stress");
  }
  if (has_rate || has_strain) {
    drive.kind = Kind::strain;
    drive.path.rate = has_rate && !has_strain ? table.real(c + "_rate", 0.0) : std::nan(""); // set with the time
    drive.path.rate_from = table.real(c + "_rate_from", drive.path.rate);
    drive.path.amplitude = table.real(c + "_strain", 0.0);
  } else if (is_cyclic) {
    drive.kind = Kind::strain;
    drive.path.kind =
        table.text("wave", "sine") == "sine" ? PrescribedStrain::Kind::sine : PrescribedStrain::Kind::triangle;
    drive.path.amplitude = table.real(c + "_amplitude", 0.0);
    drive.path.cycles = table.real("cycles", 1.0);
    if (drive.path.amplitude == 0.0 || !table.has("period")) {
      table.fail(c + "_amplitude", "must not be 0, and needs a period");
    }
  } else if (has_stress) {
    drive.kind = Kind::stress;
    drive.stress = table.real(c + "_stress", 0.0);
    drive.from_present = table.is_text(c + "_stress_from");
    drive.stress_from = drive.from_present ? std::nullopt : table.maybe_real(c + "_stress_from");
  } else {
    const std::string word = table.text(c, "fixed");
    drive.kind = word == "volume" ? Kind::volume : word == "pressure" ? Kind::pressure : Kind::fixed;
  }
}

double DeformEntry::read_time(const SceneTable& table) const {
  std::string by;
  double time = table.real("time", 0.0);
  const auto set = [&](const std::string& key, double value) {
    if (table.has("time") || (!by.empty() && std::abs(value - time) > 1e-9 * time)) {
      table.fail(key, fmt::format("makes the stage {:g} tau long, {} {:g}; give one of them", value,
                                  table.has("time") ? "time" : by, time));
    }
    by = key;
    time = value;
  };
  if (table.has("period")) {
    set("period", table.real("period", 0.0) * table.real("cycles", 1.0));
  }
  for (const std::string c : cell_components) {
    if (table.has(c + "_rate") && table.has(c + "_strain")) {
      const double rate = table.real(c + "_rate", 0.0), strain = table.real(c + "_strain", 0.0);
      if (!(rate * strain > 0.0)) {
        table.fail(c + "_rate", fmt::format("must have the sign of {}_strain = {:g}", c, strain));
      }
      set(c + "_rate", strain / rate);
    }
  }
  if (!(time > 0.0)) {
    table.fail("time", "must be given, unless a component has a rate and a strain, or cycles");
  }
  return time;
}

} // namespace boba
