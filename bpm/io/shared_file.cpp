// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/shared_file.h"

#include "bpm/io/write_all.h"

#include <fcntl.h>
#include <unistd.h>
#include <utility>

namespace boba {

SharedFile::SharedFile(const std::filesystem::path& path) : path_(path) {
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor_ < 0) {
    cannot_be_written(path_, errno);
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
  write_all({static_cast<const char*>(bytes), n}, path_, [&](const char* from, std::size_t portion) {
    const ssize_t done = pwrite(descriptor_, from, portion, static_cast<off_t>(at));
    at += done > 0 ? static_cast<std::uint64_t>(done) : 0;
    return done;
  });
}

void SharedFile::sync() {
  if (fsync(descriptor_) != 0) {
    cannot_be_written(path_, errno);
  }
}

void SharedFile::close() {
  if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0) {
    cannot_be_written(path_, errno);
  }
}

} // namespace boba
