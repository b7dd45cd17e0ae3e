// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/thread_waiting.h"

#include "base/program.h"

#include <cstdlib>

namespace boba {

void shorten_thread_waiting(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) {
    return;
  }
  if (setenv("GOMP_SPINCOUNT", "2000", 0) == 0) {
    restart_process(argv); // returns only when it fails: then the run is slower, not wrong
  }
}

} // namespace boba
