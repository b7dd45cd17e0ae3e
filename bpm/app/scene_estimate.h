// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/scene/scene.h"

#include <string>
#include <vector>

namespace boba {

struct Measurement {
  double bytes = 0.0; ///< of the engine's state, by the growth of resident memory
  double node_steps_per_second = 0.0;
  std::string instruction_set;
};

/// Runs the packing at rest for about half a second.
Measurement measure_speed(const Packing& packing, const Scene& scene);

/// What this scene does not need and therefore does not pay for.
std::vector<std::string> skipped_work(const Packing& packing, const Scene& scene);

} // namespace boba
