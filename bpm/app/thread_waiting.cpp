// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/thread_waiting.h"

#include <cstdlib>
#include <filesystem>
#include <unistd.h>

namespace boba {

void shorten_thread_waiting(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) {
    return;
  }
  if (setenv("GOMP_SPINCOUNT", "2000", 0) == 0) {
    // By its own path, so that the process keeps its name. A call returns only when it fails: then the run is slower,
    // not wrong.
    std::error_code error;
    if (const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", error); !error) {
      execv(own.c_str(), argv);
    }
    execv("/proc/self/exe", argv);
  }
}

} // namespace boba
