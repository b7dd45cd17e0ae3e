// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace boba {

/// Holds a folder for one process at a time, until it is destroyed or its process ends, however it ends.
///
/// The lock is the system's (fcntl, on the whole file, owned by the open file), which network file systems keep across
/// machines. The file says who holds it: process, machine, since when. It is removed with the lock; one that a killed
/// process left behind holds nothing. Where a file system knows no locks, what the file says decides: a process of this
/// machine that has ended holds nothing, one of another machine does until the file is removed.
class FolderLock {
public:
  enum class Means { system, record };

  /// \param file the lock's file; its folder must be there
  /// \param holder what the holder does, for messages: "boba run"
  /// \param means `record` does without the system's locks
  /// \throws InputError that names the holder when another process has it; std::runtime_error when the file cannot be
  /// written.
  FolderLock(std::filesystem::path file, const std::string& holder, Means means = Means::system);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  /// Who holds the file now, as it says itself; "" for nobody. Takes nothing and changes nothing.
  static std::string holder_of(const std::filesystem::path& file);

private:
  bool take_from_system();
  void take_by_record();

  std::filesystem::path file_;
  std::string note_;
  int descriptor_ = -1;
};

} // namespace boba
