// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/scene_estimate.h"

#include "bpm/dynamics/simulation.h"
#include "bpm/stages/hold.h"

#include <algorithm>
#include <chrono>
#include <cmath>
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

/// Height of the packing's only specimen along z (d).
double specimen_height(const Packing& packing) {
  double low = packing.position.front().z(), high = low;
  for (const Vector3& x : packing.position) {
    low = std::min(low, x.z());
    high = std::max(high, x.z());
  }
  return high - low;
}

double compress_time(const CompressStage& stage, const Packing& packing, const PackingNumbers& numbers) {
  const double p = numbers.normalised(stage.barostat.pressure);
  const double phi = 0.6 + 0.27 * std::pow(std::max(p, 0.0) / 0.1, 2.0 / 3.0);
  const double with_shell = std::pow(1.0 + 1.0 / numbers.grain_diameter, 3); // d/2 around a sphere
  const double now = numbers.phi_reference(packing.box) * with_shell;
  constexpr double settling = 1.2;
  return std::isfinite(phi) && phi > now ? settling * std::log(phi / now) / 3.0 / stage.rate : 0.0;
}

} // namespace

StageEstimates estimate_stages(const std::vector<SceneStage>& stages, const Packing& packing,
                               const PackingNumbers& numbers, double dt) {
  StageEstimates result;
  for (const SceneStage& stage : stages) {
    double time = 0.0;
    if (const auto* compress = std::get_if<CompressStage>(&stage.stage)) {
      time = compress_time(*compress, packing, numbers);
    } else if (const auto* hold = std::get_if<HoldStage>(&stage.stage)) {
      time = hold->time;
    } else if (const auto* shear = std::get_if<ShearStage>(&stage.stage)) {
      time = shear->strain / std::abs(shear->rate);
    } else if (const auto* press = std::get_if<PressStage>(&stage.stage)) {
      time = press->strain * specimen_height(packing) / (2.0 * std::abs(press->velocity));
    }
    result.steps.push_back(std::ceil(time / dt - 1e-6));
    result.exact.push_back(!std::holds_alternative<CompressStage>(stage.stage));
  }
  return result;
}

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
    const auto* shear = std::get_if<ShearStage>(&stage.stage);
    const auto* hold = std::get_if<HoldStage>(&stage.stage);
    const bool compress = std::holds_alternative<CompressStage>(stage.stage);
    held = held || compress || (shear != nullptr && shear->barostat) || (hold != nullptr && hold->barostat);
    moved = moved || compress || shear != nullptr || (hold != nullptr && hold->barostat);
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
