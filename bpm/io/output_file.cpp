// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/output_file.h"

#include "bpm/io/write_all.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <stdexcept>
#include <unistd.h>
#include <utility>
#include <zlib.h>

namespace boba {

void check_file_mode(const std::filesystem::path& path, FileMode mode) {
  if (mode == FileMode::create && std::filesystem::exists(path)) {
    throw std::runtime_error(fmt::format("{}: exists already; it is only overwritten when asked to", path.string()));
  }
}

OutputFile::OutputFile(const std::filesystem::path& path, FileMode mode) : path_(path) {
  check_file_mode(path, mode);
  errno = 0;
  if (path.extension() == ".gz") {
    gz_ = gzopen(path.c_str(), mode == FileMode::append ? "ab" : "wb");
    if (gz_ == nullptr) {
      cannot_be_written(path_, errno);
    }
    return;
  }
  const int how = O_WRONLY | O_CREAT | O_CLOEXEC | (mode == FileMode::append ? O_APPEND : O_TRUNC);
  descriptor_ = ::open(path.c_str(), how, 0666);
  if (descriptor_ < 0) {
    cannot_be_written(path_, errno);
  }
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), gz_(std::exchange(other.gz_, nullptr)),
      descriptor_(std::exchange(other.descriptor_, -1)), buffer_(std::move(other.buffer_)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(gz_, other.gz_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(buffer_, other.buffer_);
  return *this;
}

OutputFile::~OutputFile() {
  // A destructor cannot report; whoever needs to know calls close().
  try {
    close();
  } catch (const std::exception&) {
  }
}

void OutputFile::write(std::string_view bytes) {
  flush_buffer();
  put(bytes);
}

void OutputFile::flush() {
  flush_buffer();
  if (gz_ != nullptr && gzflush(gz_, Z_SYNC_FLUSH) != Z_OK) {
    cannot_be_written(path_, errno);
  }
}

void OutputFile::sync() {
  flush();
  if (descriptor_ >= 0 && fsync(descriptor_) != 0) {
    cannot_be_written(path_, errno);
  }
}

void OutputFile::close() {
  if (gz_ == nullptr && descriptor_ < 0) {
    return;
  }
  // Taken out first: a failure must neither leak the handle nor be met again by the destructor.
  OutputFile closing(std::move(*this));
  path_ = closing.path_;
  const auto drop = [&closing] {
    if (closing.gz_ != nullptr) {
      return gzclose(std::exchange(closing.gz_, nullptr)) == Z_OK;
    }
    return ::close(std::exchange(closing.descriptor_, -1)) == 0;
  };
  try {
    closing.flush_buffer();
  } catch (const std::exception&) {
    drop();
    throw;
  }
  errno = 0;
  if (!drop()) {
    cannot_be_written(path_, errno);
  }
}

void OutputFile::flush_buffer() {
  if (buffer_.size() == 0) {
    return;
  }
  try {
    put(std::string_view(buffer_.data(), buffer_.size()));
  } catch (const std::exception&) {
    buffer_.clear(); // the destructor must not try again
    throw;
  }
  buffer_.clear();
}

void OutputFile::put(std::string_view bytes) {
  write_all(bytes, path_, [this](const char* from, std::size_t n) -> ssize_t {
    return gz_ != nullptr ? gzwrite(gz_, from, static_cast<unsigned>(n)) : ::write(descriptor_, from, n);
  });
}

void sync_folder(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool is_done = descriptor >= 0 && fsync(descriptor) == 0;
  const int code = errno;
  if (descriptor >= 0) {
    ::close(descriptor);
  }
  if (!is_done) {
    throw std::runtime_error(fmt::format("{}: cannot be synced: {}", folder.string(), std::strerror(code)));
  }
}

void cut_file(const std::filesystem::path& path, std::uintmax_t length) {
  std::error_code error;
  std::filesystem::resize_file(path, length, error);
  if (error) {
    throw std::runtime_error(fmt::format("{}: cannot be cut to {} bytes: {}", path.string(), length, error.message()));
  }
}

} // namespace boba
