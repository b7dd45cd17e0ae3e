// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/thread_warning.h"

#include "bpm/app/standard_streams.h"
#include "bpm/parallel/usable_cores.h"

#include <fmt/format.h>

namespace boba {

void warn_of_threads(int threads) {
  if (const int cores = usable_cores(); threads > cores) {
    print_error(fmt::format("boba: warning: {} threads on {} usable core{}: every step waits for the slowest thread, "
                            "so this is slower than --threads {}",
                            threads, cores, cores == 1 ? "" : "s", cores));
  }
}

} // namespace boba
