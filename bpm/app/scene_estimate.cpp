// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/scene_estimate.h"

#include "bpm/dynamics/simulation.h"
#include "bpm/stages/hold.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <unistd.h>

namespace boba {

namespace {

double resident_bytes() {
  std::ifstream in("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  in >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

} // namespace

Measurement measure_speed(const Packing& packing, const Scene& scene) {
  using Clock = std::chrono::steady_clock;
  Measurement result;
  const double before = resident_bytes();
  Simulation simulation(packing, scene.material, scene.options);
  constexpr double wanted = 0.5; // s
  double seconds = 0.0;
  std::int64_t steps = 0;
  for (int n = 4; seconds < wanted; n *= 2) {
    const std::int64_t first = simulation.step();
    const Clock::time_point begin = Clock::now();
    simulation.run(0, HoldDriver({n * scene.options.dt, std::nullopt}), {});
    seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    steps = simulation.step() - first;
  }
  const auto nodes = static_cast<double>(packing.position.size());
  result.node_steps_per_second = nodes * static_cast<double>(steps) / seconds;
  // The simulation's own copy of the starting packing is part of what grew.
  result.bytes = std::max(0.0, resident_bytes() - before);
  result.instruction_set = simulation.instruction_set();
  return result;
}

std::vector<std::string> skipped_work(const Packing& packing, const Scene& scene) {
  std::vector<std::string> skipped;
  const auto is_zero = [](const Grain& grain) { return grain.alpha == 0.0; };
  const auto n_zero = std::count_if(packing.grains.begin(), packing.grains.end(), is_zero);
  if (n_zero == packing.n_grains()) {
    skipped.emplace_back("many-body pass (alpha = 0)");
  } else if (n_zero > 0) {
    skipped.emplace_back("many-body pass of " + std::to_string(n_zero) + " grains (alpha = 0)");
  }
  if (packing.n_grains() == 1) {
    skipped.emplace_back("contact search between grains (one grain)");
  }
  bool held = false, moved = false;
  for (const SceneStage& stage : scene.stages) {
    held = held || stage.entry->holds_pressure();
    moved = moved || stage.entry->moves_cell();
  }
  skipped.emplace_back(held ? "stress tensor except on steps that are written (its trace otherwise)"
                            : "virial except on steps that are written");
  if (!moved) {
    skipped.emplace_back("motion of the cell");
  }
  if (!scene.output.trajectory) {
    skipped.emplace_back("trajectory");
  }
  if (!scene.output.dump && !scene.output.vtk) {
    skipped.emplace_back("dump and VTK files");
  }
  return skipped;
}

} // namespace boba
