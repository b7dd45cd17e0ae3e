// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/small_trajectory.h"

#include "bpm/dynamics/simulation.h"
#include "bpm/io/input_error.h"
#include "bpm/io/trajectory.h"
#include "bpm/io/trajectory_packing.h"
#include "tests/support/small_packings.h"

#include <stdexcept>

namespace boba::test {

void write_small_trajectory(const std::filesystem::path& path) {
  SmallPackingSpec spec;
  spec.n_grains = 3;
  spec.radius = 1.2;
  spec.box = Box(Vector3(0.5, -1.0, 0.0), Vector3(9.0, 8.0, 7.0), Vector3(1.0, 0.5, -0.5));
  spec.least_distance = 3.6;
  spec.speed = 0.01;
  Packing packing = small_packing(spec);
  TrajectoryWriter writer(path, packing.topology(true), {"seed = 1\n", 1, "0", "0", "unknown"}, {true, 0});
  for (std::int64_t frame = 0; frame < 3; ++frame) {
    Snapshot snapshot;
    snapshot.step = 10 * frame;
    snapshot.time = static_cast<double>(frame);
    snapshot.box = packing.box;
    snapshot.position = packing.position;
    snapshot.velocity = packing.velocity;
    const auto first = packing.first_nodes();
    for (int g = 0; g < packing.n_grains(); ++g) {
      Vector3 sum = Vector3::Zero();
      for (std::int64_t node = first[g]; node < first[g + 1]; ++node) {
        sum += packing.position[node];
      }
      snapshot.grain_centre.push_back(sum / static_cast<double>(first[g + 1] - first[g]));
      snapshot.grain_stress.push_back({1, 2, 3, 4, 5, 6});
    }
    writer.write(snapshot);
    for (Vector3& x : packing.position) {
      x += Vector3(0.01, 0.02, 0.0);
    }
  }
  writer.close();
}

void use_trajectory(const std::filesystem::path& path) {
  const TrajectoryReader reader(path);
  for (std::int64_t frame = 0; frame < reader.n_frames(); ++frame) {
    reader.snapshot(frame);
  }
  if (reader.n_frames() == 0) {
    return;
  }
  Simulation simulation(read_trajectory_packing(path, -1), Material{}, SimulationOptions{});
  try {
    simulation.evaluate();
  } catch (const std::runtime_error&) { // forces that are no numbers, said so
  }
}

} // namespace boba::test
