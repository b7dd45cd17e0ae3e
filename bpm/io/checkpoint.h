// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/saved_state.h"
#include "bpm/io/node_runs.h"
#include "bpm/parallel/ranks.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace boba {

/// The newest checkpoint that is whole.
struct LatestCheckpoint {
  std::filesystem::path path;
  SavedState data;
  std::vector<std::string> refused; ///< why each newer one was not taken, with its name; newest first
};

/// Writes `directory/checkpoint-NNNNNN.boba` (numbered on from what is there) and returns its path.
///
/// The file is written beside its final name, fsynced with its folder and only then renamed, so a crash at any moment
/// leaves the older ones intact; it carries its length and a checksum (CRC-32) of all its bytes. Of the whole
/// checkpoints the newest `keep` remain, older files are removed. \throws std::runtime_error when it cannot be written
/// (disk full, ...); the older ones then remain.
std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const SavedState& data, int keep = 2);

/// Fields of three values per node, of which each rank has its own nodes.
struct NodeFields {
  std::vector<std::string> names; ///< the same on all ranks
  std::vector<NodeRun> own;       ///< the nodes of this rank, in the order in which its fields hold them
  std::int64_t n_nodes = 0;       ///< of all ranks
};

/// The same file, written by all ranks: of the fields of nodes each writes its own nodes, all else is rank 0's. The
/// path is returned on rank 0. Collective. \throws RankError on all ranks when any of them fails.
std::filesystem::path write_checkpoint(const std::filesystem::path& directory, const SavedState& data,
                                       const Ranks& ranks, const NodeFields& nodes, int keep = 2);

/// Reads one checkpoint. \throws InputError naming the file when it is missing, truncated, altered or of an older
/// version.
SavedState read_checkpoint(const std::filesystem::path& path);

/// Reads the newest checkpoint of a folder that is whole. \throws InputError naming each refused one when there is
/// none.
LatestCheckpoint latest_checkpoint(const std::filesystem::path& directory);

} // namespace boba
