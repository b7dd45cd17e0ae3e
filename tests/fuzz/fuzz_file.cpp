// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/fuzz_file.h"

#include <cerrno>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <system_error>
#include <unistd.h>

namespace boba::fuzz {

std::filesystem::path file_of(std::span<const std::uint8_t> bytes) {
  static const int descriptor = memfd_create("fuzz", 0);
  if (descriptor < 0 || ftruncate(descriptor, 0) != 0 ||
      pwrite(descriptor, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("fuzz: " + std::generic_category().message(errno));
  }
  return "/proc/self/fd/" + std::to_string(descriptor);
}

} // namespace boba::fuzz
