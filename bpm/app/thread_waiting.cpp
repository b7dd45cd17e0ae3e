// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/thread_waiting.h"

#include <cstdlib>
#include <unistd.h>

namespace boba {

void shorten_thread_waiting(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) {
    return;
  }
  if (setenv("GOMP_SPINCOUNT", "2000", 0) == 0) {
    execv("/proc/self/exe", argv); // returns only when it fails: then the run is slower, not wrong
  }
}

} // namespace boba
