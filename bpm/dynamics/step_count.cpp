// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/step_count.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

std::int64_t step_count(double duration, double dt) {
  const double steps = std::ceil(duration / dt - 1e-6);
  if (!(steps <= most_steps)) {
    throw std::invalid_argument(
        fmt::format("a stage of {:g} tau takes {:g} steps of dt = {:g} tau; allowed: at most {:g}", duration, steps, dt,
                    most_steps));
  }
  return static_cast<std::int64_t>(steps);
}

} // namespace boba
