// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_cache.h"

#include "bpm/grain/build_template.h"
#include "bpm/grain/template_file.h"

#include <array>
#include <cstdlib>
#include <fmt/format.h>
#include <pwd.h>
#include <stdexcept>
#include <string_view>
#include <unistd.h>

namespace boba {

namespace fs = std::filesystem;

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
  return !directory_.empty() && read_template(file_of(spec), canonical_text(spec)).has_value();
}

GrainTemplate TemplateCache::get(const TemplateSpec& spec, const std::function<void()>& before_build) const {
  validate(spec);
  const std::string text = canonical_text(spec);
  if (auto stored = directory_.empty() ? std::nullopt : read_template(file_of(spec), text)) {
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
