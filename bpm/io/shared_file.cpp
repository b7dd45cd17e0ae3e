// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/shared_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdexcept>
#include <unistd.h>
#include <utility>

namespace boba {

SharedFile::SharedFile(const std::filesystem::path& path) : path_(path) {
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor_ < 0) {
    fail(errno);
  }
}

SharedFile::SharedFile(SharedFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

SharedFile& SharedFile::operator=(SharedFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

SharedFile::~SharedFile() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

void SharedFile::write(std::uint64_t at, const void* bytes, std::size_t n) {
  const char* from = static_cast<const char*>(bytes);
  while (n > 0) {
    errno = 0;
    const ssize_t done = pwrite(descriptor_, from, std::min<std::size_t>(n, 1 << 30), static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) {
      continue;
    }
    if (done <= 0) {
      fail(errno);
    }
    from += done;
    at += static_cast<std::uint64_t>(done);
    n -= static_cast<std::size_t>(done);
  }
}

void SharedFile::sync() {
  if (fsync(descriptor_) != 0) {
    fail(errno);
  }
}

void SharedFile::close() {
  if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0) {
    fail(errno);
  }
}

void SharedFile::fail(int code) const {
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}", path_.string(), code != 0 ? std::strerror(code) : "unknown error"));
}

} // namespace boba
