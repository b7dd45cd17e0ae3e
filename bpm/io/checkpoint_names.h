// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace boba {

struct NumberedCheckpoint {
  std::uint64_t number = 0;
  std::filesystem::path path;
};

/// checkpoint-NNNNNN.boba
std::string checkpoint_name(std::uint64_t number);

/// The checkpoints of a folder, newest first; none when it is not there.
std::vector<NumberedCheckpoint> checkpoints_in(const std::filesystem::path& directory);

} // namespace boba
