// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/input_error.h"

#include <filesystem>
#include <fmt/format.h>

namespace boba {

/// Runs a step of the making and puts the file's name in front of what it refuses.
template <typename Call> auto naming(const std::filesystem::path& path, Call call) {
  try {
    return call();
  } catch (const InputError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

} // namespace boba
