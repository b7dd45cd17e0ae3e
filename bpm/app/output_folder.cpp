// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/output_folder.h"

#include "bpm/io/input_error.h"

#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace fs = std::filesystem;

void OutputFolder::check_free(bool force) const {
  std::error_code error;
  if (!fs::exists(root_, error)) {
    return;
  }
  if (!fs::is_directory(root_, error)) {
    throw InputError(fmt::format("output: {} is not a folder", root_.string()));
  }
  if (!force && !fs::is_empty(root_, error)) {
    throw InputError(
        fmt::format("output: {0} is there already and not empty; --force replaces the run in it, --output names "
                    "another folder, boba resume {0} goes on with it",
                    root_.string()));
  }
}

void OutputFolder::create(bool force) const {
  std::error_code error;
  fs::create_directories(root_, error);
  if (error) {
    throw std::runtime_error(fmt::format("output: {} cannot be made: {}", root_.string(), error.message()));
  }
  if (!force) {
    return;
  }
  for (const fs::path& old : {scene(), log(), table(), trajectory(), dump(), vtk(), measures(), checkpoints()}) {
    fs::remove_all(old, error);
    if (error) {
      throw std::runtime_error(fmt::format("output: {} cannot be removed: {}", old.string(), error.message()));
    }
  }
}

} // namespace boba
