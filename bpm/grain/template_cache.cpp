// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_cache.h"

#include "bpm/grain/build_template.h"
#include "bpm/grain/template_file.h"

#include <cstdlib>
#include <fmt/format.h>
#include <stdexcept>

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
  throw std::runtime_error("no place for the grain template cache: set BOBA_CACHE_DIR, XDG_CACHE_HOME or HOME");
}

TemplateCache::TemplateCache(fs::path directory) : directory_(std::move(directory)) {}

fs::path TemplateCache::file_of(const TemplateSpec& spec) const {
  return directory_ / fmt::format("template-{:016x}.h5", template_hash(canonical_text(spec)));
}

bool TemplateCache::contains(const TemplateSpec& spec) const {
  return read_template(file_of(spec), canonical_text(spec)).has_value();
}

GrainTemplate TemplateCache::get(const TemplateSpec& spec, const std::function<void()>& before_build) const {
  validate(spec);
  const std::string text = canonical_text(spec);
  if (auto stored = read_template(file_of(spec), text)) {
    return *std::move(stored);
  }
  if (before_build) {
    before_build();
  }
  GrainTemplate grain = build_template(spec);
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
