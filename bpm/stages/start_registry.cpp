// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/start_registry.h"

#include "bpm/stages/insert.h"
#include "bpm/stages/lammps_start.h"
#include "bpm/stages/specimen.h"
#include "bpm/stages/trajectory_start.h"
#include "bpm/toml/schema.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>

namespace boba {

namespace {

/// The starts that Boba has of itself: one line each.
std::vector<StartKind>& registered_starts() {
  static std::vector<StartKind> kinds = {
      start_kind<InsertStart>(),
      start_kind<SpecimenStart>(),
      start_kind<LammpsStart>(),
      start_kind<TrajectoryStart>(),
  };
  return kinds;
}

std::vector<const StartKind*> file_starts() {
  std::vector<const StartKind*> starts;
  for (const StartKind& kind : registered_starts()) {
    if (kind.is_from_files()) {
      starts.push_back(&kind);
    }
  }
  return starts;
}

bool same_name(const StartKind& a, const StartKind& b) {
  return a.is_from_files() == b.is_from_files() &&
         (a.is_from_files() ? a.file_key() == b.file_key() : a.section.kind == b.section.kind);
}

} // namespace

void register_start(StartKind kind) {
  if (std::ranges::any_of(registered_starts(), [&](const StartKind& other) { return same_name(kind, other); })) {
    throw std::logic_error(
        fmt::format("there is a start \"{}\" already", kind.is_from_files() ? kind.file_key() : kind.section.kind));
  }
  registered_starts().push_back(std::move(kind));
}

const std::vector<StartKind>& start_kinds() {
  return registered_starts();
}

const StartKind* find_placing_start(const std::string& type) {
  const auto at = std::ranges::find_if(
      registered_starts(), [&](const StartKind& kind) { return !kind.is_from_files() && kind.section.kind == type; });
  return at == registered_starts().end() ? nullptr : &*at;
}

SceneSection start_section() {
  std::vector<std::string> what;
  SceneSection section = {"start", "", false, "", {}};
  for (const StartKind* start : file_starts()) {
    what.push_back(start->section.doc);
    section.keys = joined(std::move(section.keys), start->section.keys);
  }
  section.doc = fmt::format("Start from files instead of an `insert` stage: {}.", fmt::join(what, ", or "));
  section.keys.push_back(
      integer_key("frame", -1e9, 1e9, "-1", "frame of the trajectory or dump, counted from 0; negative from the end"));
  section.keys = joined(joined(std::move(section.keys), alpha_keys(false)), bond_keys());
  return section;
}

const StartKind& chosen_file_start(const SceneTable& table) {
  const StartKind* chosen = nullptr;
  std::vector<std::string> others;
  bool is_one = true;
  for (const StartKind* start : file_starts()) {
    is_one = is_one && !(chosen != nullptr && table.has(start->file_key()));
    chosen = table.has(start->file_key()) ? start : chosen;
    others.push_back("start." + start->file_key());
  }
  if (chosen == nullptr || !is_one) {
    others.erase(others.begin());
    table.fail(file_starts().front()->file_key(),
               fmt::format("or {} must be given, and only one of them", fmt::join(others, " or ")));
  }
  for (const StartKind* other : file_starts()) {
    for (const SceneKey& key : other->section.keys) {
      if (other != chosen && table.has(key.name)) {
        table.fail(key.name, fmt::format("belongs to {}, not to {}", other->file_key(), chosen->file_key()));
      }
    }
  }
  return *chosen;
}

} // namespace boba
