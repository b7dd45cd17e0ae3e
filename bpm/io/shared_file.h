// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace boba {

/// A file that is there already and that several ranks write into, each at places of its own.
///
/// \throws std::runtime_error from any member when the system refuses, naming the file and the reason.
class SharedFile {
public:
  explicit SharedFile(const std::filesystem::path& path);
  SharedFile(SharedFile&&) noexcept;
  SharedFile& operator=(SharedFile&&) noexcept;
  ~SharedFile();

  /// `at`: bytes from the begin of the file.
  void write(std::uint64_t at, const void* bytes, std::size_t n);
  /// Waits until everything this rank wrote is on the disk itself.
  void sync();
  /// Without it errors of the last write may go unseen.
  void close();

private:
  std::filesystem::path path_;
  int descriptor_ = -1;
};

} // namespace boba
