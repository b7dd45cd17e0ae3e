// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/output_folder.h"

#include <fmt/format.h>
#include <stdexcept>

namespace boba {

void OutputFolder::create() const {
  std::error_code error;
  std::filesystem::create_directories(root_, error);
  if (error) {
    throw std::runtime_error(fmt::format("output: {} cannot be made: {}", root_.string(), error.message()));
  }
}

} // namespace boba
