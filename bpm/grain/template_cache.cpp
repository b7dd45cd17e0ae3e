// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_cache.h"

#include "base/bounds.h"
#include "bpm/grain/bond_network.h"
#include "bpm/grain/build_template.h"
#include "bpm/grain/template_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <pwd.h>
#include <stdexcept>
#include <string_view>
#include <unistd.h>

namespace boba {

namespace fs = std::filesystem;

namespace {

/// Is it a template that build_template could have made of `spec`? A checksum that fits says who wrote the file, not
/// that its numbers belong together: bonds and rest lengths follow from the positions once more.
bool belongs_to(const TemplateSpec& spec, const GrainTemplate& grain) {
  if (is_single_node(spec)) {
    return grain.n_nodes() == 1 && grain.bonds.empty();
  }
  const bool is_periodic = spec.shape == TemplateSpec::Shape::periodic_box;
  if (is_periodic != grain.period.has_value() || (spec.n_nodes && *spec.n_nodes != grain.n_nodes())) {
    return false;
  }
  const double volume = is_periodic ? grain.period->prod() : grain.n_nodes() / spec.density;
  if (!(std::abs(grain.reference_volume - volume) <= 1e-9 * volume)) {
    return false;
  }
  // Grains are compact: their bounding cuboid is not far larger than what they stand for.
  if (!((bounds_of(grain.position).extent().array() + spec.bond_cutoff).prod() <= 1e3 * (volume + 1e3))) {
    return false;
  }
  const std::vector<Bond> bonds = bonds_closer_than(grain.position, spec.bond_cutoff, grain.period);
  const auto same = [](const Bond& a, const Bond& b) {
    return a.i == b.i && a.j == b.j && std::abs(a.r0 - b.r0) <= 1e-9 * b.r0;
  };
  return std::equal(bonds.begin(), bonds.end(), grain.bonds.begin(), grain.bonds.end(), same) && !floating_part(grain);
}

std::optional<GrainTemplate> stored_template(const fs::path& file, const TemplateSpec& spec) {
  std::optional<GrainTemplate> grain = read_template(file, canonical_text(spec));
  try {
    return grain && belongs_to(spec, *grain) ? std::move(grain) : std::nullopt;
  } catch (const std::invalid_argument&) { // a period too short for the bonds
    return std::nullopt;
  }
}

} // namespace

fs::path default_cache_directory() {
  const auto variable = [](const char* name) -> std::string {
    const char* value = std::getenv(name);
    return value ? value : "";
  };
  if (const std::string own = variable("BOBA_CACHE_DIR"); !own.empty()) {
    return own;
  }
  if (const std::string shared = variable("XDG_CACHE_HOME"); !shared.empty()) {
    return fs::path(shared) / "boba";
  }
  if (const std::string home = variable("HOME"); !home.empty()) {
    return fs::path(home) / ".cache" / "boba";
  }
  std::array<char, 4096> room{};
  passwd entry{}, *found = nullptr;
  if (getpwuid_r(getuid(), &entry, room.data(), room.size(), &found) == 0 && found != nullptr &&
      std::string_view(entry.pw_dir).starts_with("/")) {
    return fs::path(entry.pw_dir) / ".cache" / "boba";
  }
  return {}; // nowhere: templates are built each time
}

TemplateCache::TemplateCache(fs::path directory) : directory_(std::move(directory)) {}

fs::path TemplateCache::file_of(const TemplateSpec& spec) const {
  return directory_ / fmt::format("template-{:016x}.h5", template_hash(canonical_text(spec)));
}

bool TemplateCache::contains(const TemplateSpec& spec) const {
  return !directory_.empty() && stored_template(file_of(spec), spec).has_value();
}

GrainTemplate TemplateCache::get(const TemplateSpec& spec, const std::function<void()>& before_build) const {
  validate(spec);
  const std::string text = canonical_text(spec);
  if (auto stored = directory_.empty() ? std::nullopt : stored_template(file_of(spec), spec)) {
    return *std::move(stored);
  }
  if (before_build) {
    before_build();
  }
  GrainTemplate grain = build_template(spec);
  if (directory_.empty()) {
    return grain;
  }
  std::error_code no_directory;
  fs::create_directories(directory_, no_directory);
  try {
    write_template(file_of(spec), grain, text);
  } catch (const std::runtime_error&) {
    // Read-only home or full disk: the template itself is good.
  }
  return grain;
}

} // namespace boba
