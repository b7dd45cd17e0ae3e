// SPDX-License-Identifier: GPL-3.0-or-later
// Loaded before the C library (LD_PRELOAD): makes one of the calls that change files fail as on a full disk.
// BOBA_FAIL_AT: number of the call, from 1. BOBA_FAIL_ON: every later one fails too. BOBA_FAIL_COUNT: file that gets
// the number of calls at the end. BOBA_FAIL_NAME: only files with this in their path count. Standard output and error
// are left alone.
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

namespace {

std::atomic<long> n_calls{0};

long number(const char* name) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atol(text) : 0;
}

bool fails() {
  static const long at = number("BOBA_FAIL_AT");
  static const bool later_too = number("BOBA_FAIL_ON") != 0;
  const long call = ++n_calls;
  const bool now = at > 0 && (call == at || (later_too && call > at));
  if (now) {
    errno = ENOSPC;
  }
  return now;
}

bool is_meant(const char* path) {
  const char* part = std::getenv("BOBA_FAIL_NAME");
  return part == nullptr || std::strstr(path, part) != nullptr;
}

/// False for standard output and error, and for what has no name in any folder (memory).
bool is_on_disk(int descriptor) {
  struct stat status = {};
  if (descriptor <= 2 || fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode) || status.st_nlink == 0) {
    return false;
  }
  char link[64], path[4096] = {};
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  return readlink(link, path, sizeof path - 1) > 0 && is_meant(path);
}

template <typename Function> Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

struct Reporter {
  ~Reporter() {
    if (const char* path = std::getenv("BOBA_FAIL_COUNT")) {
      if (std::FILE* file = std::fopen(path, "w")) {
        std::fprintf(file, "%ld\n", n_calls.load());
        std::fclose(file);
      }
    }
  }
} reporter;

} // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t n) {
  static auto* const real = next<ssize_t(int, const void*, size_t)>("write");
  return is_on_disk(descriptor) && fails() ? -1 : real(descriptor, bytes, n);
}

ssize_t pwrite(int descriptor, const void* bytes, size_t n, off_t at) {
  static auto* const real = next<ssize_t(int, const void*, size_t, off_t)>("pwrite");
  return is_on_disk(descriptor) && fails() ? -1 : real(descriptor, bytes, n, at);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t n, off64_t at) {
  static auto* const real = next<ssize_t(int, const void*, size_t, off64_t)>("pwrite64");
  return is_on_disk(descriptor) && fails() ? -1 : real(descriptor, bytes, n, at);
}

int fsync(int descriptor) {
  static auto* const real = next<int(int)>("fsync");
  return is_on_disk(descriptor) && fails() ? -1 : real(descriptor);
}

int ftruncate(int descriptor, off_t length) noexcept {
  static auto* const real = next<int(int, off_t)>("ftruncate");
  return is_on_disk(descriptor) && fails() ? -1 : real(descriptor, length);
}

int ftruncate64(int descriptor, off64_t length) noexcept {
  static auto* const real = next<int(int, off64_t)>("ftruncate64");
  return is_on_disk(descriptor) && fails() ? -1 : real(descriptor, length);
}

int fallocate(int descriptor, int mode, off_t at, off_t length) {
  static auto* const real = next<int(int, int, off_t, off_t)>("fallocate");
  return is_on_disk(descriptor) && fails() ? -1 : real(descriptor, mode, at, length);
}

int rename(const char* from, const char* to) noexcept {
  static auto* const real = next<int(const char*, const char*)>("rename");
  return is_meant(to) && fails() ? -1 : real(from, to);
}
}
