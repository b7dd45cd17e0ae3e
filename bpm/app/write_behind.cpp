// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/write_behind.h"

namespace boba {

void WriteBehind::add(Snapshot&& frame) {
  wait();
  written_ = std::async(std::launch::async, [this, own = std::move(frame)] { write_(own); });
}

void WriteBehind::wait() {
  if (written_.valid()) {
    written_.get();
  }
}

} // namespace boba
