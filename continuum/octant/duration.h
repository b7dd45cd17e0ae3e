// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba::continuum {

/// How long a phase took on this rank: by the clock, and of the processor's time (waiting apart). Seconds.
struct Duration {
  double wall = 0, cpu = 0;

  Duration& operator+=(const Duration& other) {
    wall += other.wall;
    cpu += other.cpu;
    return *this;
  }
};

} // namespace boba::continuum
