// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/stage.h"

#include "bpm/dynamics/step_count.h"

#include <fmt/format.h>

namespace boba {

void require_periodic_cell(const SceneTable& table, const StageSurroundings& surroundings) {
  if (surroundings.cell_is_open) {
    table.fail("type", "needs a periodic cell; a specimen's is open");
  }
}

void require_open_cell(const SceneTable& table, const StageSurroundings& surroundings) {
  if (!surroundings.cell_is_open) {
    table.fail("type",
               "needs an open cell: begin with a \"specimen\" stage, or with walls = \"z\" or \"xyz\" of insert");
  }
}

void require_countable_steps(const SceneTable& table, const std::string& key, double duration, double dt) {
  if (!(duration / dt <= most_steps)) {
    table.fail(key, fmt::format("makes a stage of {:g} steps; allowed: at most {:g}", duration / dt, most_steps));
  }
}

} // namespace boba
