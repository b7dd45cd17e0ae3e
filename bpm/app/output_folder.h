// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace boba {

/// Name of the lock in an output folder, see FolderLock.
constexpr const char* lock_file_name = "run.lock";

/// The folder of one run and the names in it. Everything that a run writes lies here.
class OutputFolder {
public:
  explicit OutputFolder(std::filesystem::path root) : root_(std::move(root)) {}

  const std::filesystem::path& root() const { return root_; }
  std::filesystem::path lock() const { return root_ / lock_file_name; }
  std::filesystem::path file_list() const { return root_ / "files.txt"; }
  std::filesystem::path scene() const { return root_ / "scene.toml"; }
  std::filesystem::path log() const { return root_ / "run.log"; }
  std::filesystem::path table() const { return root_ / "table.csv"; }
  std::filesystem::path trajectory() const { return root_ / "trajectory.h5"; }
  std::filesystem::path dump() const { return root_ / "dump.lammpstrj"; }
  std::filesystem::path vtk() const { return root_ / "vtk"; }
  std::filesystem::path measures() const { return root_ / "measures"; }
  std::filesystem::path checkpoints() const { return root_ / "checkpoints"; }

  /// Makes the folder where it is missing. \throws std::runtime_error when the system refuses.
  void create() const;

private:
  std::filesystem::path root_;
};

} // namespace boba
