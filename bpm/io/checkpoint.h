// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace boba {

/// Named values that a run needs to go on bit for bit.
struct CheckpointData {
  std::map<std::string, std::string> text;
  std::map<std::string, std::vector<double>> real;
  std::map<std::string, std::vector<std::int64_t>> integer;
};

/// The newest checkpoint that is whole.
struct LatestCheckpoint {
  std::filesystem::path path;
  CheckpointData data;
  std::vector<std::string> refused; ///< why each newer one was not taken, with its name; newest first
};

/// Writes `directory/checkpoint-NNNNNN.boba` (numbered on from what is there) and returns its path.
///
/// The file is written beside its final name, fsynced with its folder and only then renamed, so a crash at any moment
/// leaves the older ones intact; it carries its length and an XXH3 checksum of all its bytes. Of the whole checkpoints
/// the newest `keep` remain, older files are removed. \throws std::runtime_error when it cannot be written (disk full,
/// ...); the older ones then remain.
std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const CheckpointData& data,
                                       int keep = 2);

/// Reads one checkpoint. \throws InputError naming the file when it is missing, truncated or altered.
CheckpointData read_checkpoint(const std::filesystem::path& path);

/// Reads the newest checkpoint of a folder that is whole. \throws InputError naming each refused one when there is
/// none.
LatestCheckpoint latest_checkpoint(const std::filesystem::path& directory);

} // namespace boba
