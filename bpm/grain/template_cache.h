// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "bpm/grain/template_spec.h"

#include <filesystem>
#include <functional>

namespace boba {

/// $BOBA_CACHE_DIR, else $XDG_CACHE_HOME/boba, else $HOME/.cache/boba; without HOME the user's home as the system knows
/// it. Empty when there is none: templates are then built each time.
std::filesystem::path default_cache_directory();

/// Templates on disk, one HDF5 file each, named by the hash of the specification.
///
/// A file is used only if it holds the same canonical text, its checksum is right and its bonds are those of its nodes;
/// otherwise it is built again and replaced. Files are written beside and renamed, so several programs may share a
/// directory. A directory that cannot be written costs the saving, not the template.
class TemplateCache {
public:
  explicit TemplateCache(std::filesystem::path directory = default_cache_directory());

  /// The template of `spec`, from disk if it is there, else built (and stored). `before_build` is called first in that
  /// case: the place to tell a person why it takes a while.
  /// \throws std::invalid_argument, std::runtime_error as build_template does.
  GrainTemplate get(const TemplateSpec& spec, const std::function<void()>& before_build = {}) const;

  bool contains(const TemplateSpec& spec) const;
  std::filesystem::path file_of(const TemplateSpec& spec) const;

private:
  std::filesystem::path directory_;
};

} // namespace boba
