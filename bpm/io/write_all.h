// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>
#include <sys/types.h>

namespace boba {

/// \throws std::runtime_error that names the file and the system's reason, always.
[[noreturn]] inline void cannot_be_written(const std::filesystem::path& path, int code) {
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}", path.string(), code != 0 ? std::strerror(code) : "unknown error"));
}

/// Calls write_some(bytes, portion), which returns as write(2) does, until all bytes are written.
/// \throws std::runtime_error as cannot_be_written when the system takes no more.
template <class WriteSome>
void write_all(std::string_view bytes, const std::filesystem::path& path, const WriteSome& write_some) {
  while (!bytes.empty()) {
    errno = 0;
    const ssize_t done = write_some(bytes.data(), std::min<std::size_t>(bytes.size(), 1 << 30));
    if (done < 0 && errno == EINTR) {
      continue;
    }
    if (done <= 0) {
      cannot_be_written(path, errno);
    }
    bytes.remove_prefix(static_cast<std::size_t>(done));
  }
}

} // namespace boba
