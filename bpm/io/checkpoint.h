// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/node_runs.h"
#include "bpm/parallel/ranks.h"

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
/// leaves the older ones intact; it carries its length and a checksum (CRC-32) of all its bytes. Of the whole
/// checkpoints the newest `keep` remain, older files are removed. \throws std::runtime_error when it cannot be written
/// (disk full, ...); the older ones then remain.
std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const CheckpointData& data,
                                       int keep = 2);

/// Entries of three values a node, of which each rank has its own nodes.
struct NodeEntries {
  std::vector<std::string> names; ///< reals or integers of CheckpointData, the same on all ranks
  std::vector<NodeRun> own;       ///< the nodes of this rank, in the order in which its entries hold them
  std::int64_t n_nodes = 0;       ///< of all ranks
};

/// The same file, written by all ranks: of the entries of nodes each writes its own nodes, all else is rank 0's. The
/// path is returned on rank 0. Collective. \throws RankError on all ranks when any of them fails.
std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const CheckpointData& data,
                                       const Ranks& ranks, const NodeEntries& nodes, int keep = 2);

/// Reads one checkpoint. \throws InputError naming the file when it is missing, truncated, altered or of an older
/// version.
CheckpointData read_checkpoint(const std::filesystem::path& path);

/// Reads the newest checkpoint of a folder that is whole. \throws InputError naming each refused one when there is
/// none.
LatestCheckpoint latest_checkpoint(const std::filesystem::path& directory);

} // namespace boba
