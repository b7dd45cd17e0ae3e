// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/named_loadings.h"

#include "bpm/toml/schema.h"

#include <cmath>

namespace boba {

namespace {

using Kind = ComponentDrive::Kind;

SceneKey axis_key(const std::string& name, const std::string& fallback, const std::string& doc) {
  return choice_key(name, {"x", "y", "z"}, fallback.empty() ? "" : "\"" + fallback + "\"", doc);
}

int axis_of(const SceneTable& table, const std::string& key, const std::string& fallback) {
  return table.text(key, fallback)[0] - 'x';
}

std::vector<SceneKey> axial_keys() {
  return {axis_key("axis", "z", "that is strained"),
          required(real_key("strain", "", -10.0, 10.0, "", "to reach along the axis; negative compresses, not 0")),
          required(above_key("rate", "1/tau", 0.0, 0.1, "", "how fast, whatever the sign of the strain")),
          measure_key()};
}

SceneKey confining_key() {
  return required(
      above_key("confining_pressure", "k/d", 0.0, 100.0, "", "to hold across the axis, compression positive"));
}

/// Drives the axis to its strain and returns it.
int drive_axis(const SceneTable& table, DeformStage& stage, double& time) {
  const double strain = table.real("strain", 0.0);
  if (strain == 0.0) {
    table.fail("strain", "must not be 0");
  }
  const int axis = axis_of(table, "axis", "z");
  const double rate = std::copysign(table.real("rate", 0.0), strain);
  stage.component[axis].kind = Kind::strain;
  stage.component[axis].path.rate_from = stage.component[axis].path.rate = rate;
  time = strain / rate;
  return axis;
}

/// The axis of `key`, which must not be `taken`.
int other_axis(const SceneTable& table, const std::string& key, const std::string& fallback, int taken) {
  const int axis = axis_of(table, key, fallback);
  if (axis == taken) {
    table.fail(key, "must not be the axis that is strained");
  }
  return axis;
}

void hold_stress(DeformStage& stage, int axis, double stress) {
  stage.component[axis].kind = Kind::stress;
  stage.component[axis].stress = stress;
}

std::string next_axis(int axis) {
  return std::string(1, static_cast<char>('x' + (axis + 1) % 3));
}

} // namespace

SceneSection UniaxialEntry::section() {
  return {"stage", "uniaxial", true,
          "Strains one axis while the other two normal stresses are held at zero: Young's modulus and Poisson's ratio.",
          joined(axial_keys(), servo_keys())};
}

UniaxialEntry::UniaxialEntry(const SceneTable& table) : LoadingEntry(table) {
  double time = 0.0;
  const int axis = drive_axis(table, stage_, time);
  hold_stress(stage_, (axis + 1) % 3, 0.0);
  hold_stress(stage_, (axis + 2) % 3, 0.0);
  set_time(table, time);
}

SceneSection TriaxialEntry::section() {
  return {"stage", "triaxial", true,
          "Strains one axis while the other two normal stresses are held at the confining pressure.",
          joined(joined(axial_keys(), {confining_key(), normalised_key()}), servo_keys())};
}

TriaxialEntry::TriaxialEntry(const SceneTable& table) : LoadingEntry(table) {
  double time = 0.0;
  const int axis = drive_axis(table, stage_, time);
  const double pressure = table.real("confining_pressure", 0.0);
  hold_stress(stage_, (axis + 1) % 3, -pressure);
  hold_stress(stage_, (axis + 2) % 3, -pressure);
  set_time(table, time);
}

SceneSection BiaxialEntry::section() {
  return {"stage", "biaxial", true,
          "Plane strain: strains one axis, keeps a second fixed and holds the confining pressure along the third.",
          joined(joined(axial_keys(), {axis_key("fixed_axis", "", "default: the one after the strained one"),
                                       confining_key(), normalised_key()}),
                 servo_keys())};
}

BiaxialEntry::BiaxialEntry(const SceneTable& table) : LoadingEntry(table) {
  double time = 0.0;
  const int axis = drive_axis(table, stage_, time);
  const int fixed = other_axis(table, "fixed_axis", next_axis(axis), axis);
  hold_stress(stage_, 3 - axis - fixed, -table.real("confining_pressure", 0.0));
  set_time(table, time);
}

SceneSection OedometerEntry::section() {
  return {"stage", "oedometer", true, "Strains one axis while the other two are fixed.", axial_keys()};
}

OedometerEntry::OedometerEntry(const SceneTable& table) : LoadingEntry(table) {
  double time = 0.0;
  drive_axis(table, stage_, time);
  set_time(table, time);
}

SceneSection PureShearEntry::section() {
  return {"stage", "pure_shear", true, "Strains one axis while a second keeps the volume and the third is fixed.",
          joined(axial_keys(), {axis_key("other_axis", "", "that keeps the volume; default: the one after the axis")})};
}

PureShearEntry::PureShearEntry(const SceneTable& table) : LoadingEntry(table) {
  double time = 0.0;
  const int axis = drive_axis(table, stage_, time);
  stage_.component[other_axis(table, "other_axis", next_axis(axis), axis)].kind = Kind::volume;
  set_time(table, time);
}

} // namespace boba
