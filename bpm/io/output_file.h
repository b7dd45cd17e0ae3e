// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <string_view>

struct gzFile_s;

namespace boba {

/// What a writer does with a file that is there already.
enum class FileMode {
  create,    ///< refuse it
  overwrite, ///< replace it
  append     ///< go on at its end (it may also be missing)
};

/// Throws std::runtime_error unless `mode` allows to write to `path`.
void check_file_mode(const std::filesystem::path& path, FileMode mode);

/// A text or binary output file, gzipped when its name ends in .gz, that reports every failed write.
///
/// \throws std::runtime_error from any member when the system refuses (disk full, no such folder, ...).
class OutputFile {
public:
  OutputFile(const std::filesystem::path& path, FileMode mode);
  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) noexcept;
  ~OutputFile();

  void write(std::string_view bytes);
  template <typename... Args> void print(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(buffer_), format, std::forward<Args>(args)...);
    if (buffer_.size() > flush_above) {
      flush_buffer();
    }
  }
  /// Hands everything to the operating system, so that it outlives the process.
  void flush();
  /// Waits until everything is on the disk itself, so that it outlives the machine's power (not for .gz).
  void sync();
  /// Flushes and closes; without it errors of the last write would go unseen.
  void close();

private:
  static constexpr std::size_t flush_above = 1 << 18;
  void flush_buffer();
  void put(std::string_view bytes);

  std::filesystem::path path_;
  gzFile_s* gz_ = nullptr;
  int descriptor_ = -1;
  fmt::memory_buffer buffer_;
};

/// Waits until the names in a folder (a file just made or renamed) are on the disk. \throws std::runtime_error on
/// failure.
void sync_folder(const std::filesystem::path& folder);

/// Cuts a file at a length in bytes. \throws std::runtime_error when the system refuses.
void cut_file(const std::filesystem::path& path, std::uintmax_t length);

} // namespace boba
