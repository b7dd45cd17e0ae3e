// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a trajectory on the ranks it is started on: FILE VELOCITIES COMPRESSION FIRST LAST. Frames FIRST .. LAST of a
// packing whose grains change their owner from frame to frame; from the second on the file is gone on with.
#include "bpm/io/shared_trajectory.h"
#include "bpm/parallel/message_passing.h"
#include "tests/support/small_packings.h"

#include <cstdlib>
#include <fmt/format.h>
#include <random>

namespace boba::test {
namespace {

/// The same on all ranks.
Snapshot frame_of(const Packing& packing, std::int64_t step) {
  Snapshot snapshot;
  std::mt19937 random(static_cast<unsigned>(step));
  std::normal_distribution<double> far(0.0, 30.0);
  const auto vector = [&] {
    const double x = far(random), y = far(random);
    return Vector3(x, y, far(random));
  };
  snapshot.step = step;
  snapshot.time = 0.1 * static_cast<double>(step);
  snapshot.box = packing.box;
  const std::vector<std::int64_t> first = packing.first_nodes();
  for (int g = 0; g < packing.n_grains(); ++g) {
    const Vector3 shift = vector(); // grains fly far, but stay whole
    Vector3 sum = Vector3::Zero();
    for (std::int64_t node = first[g]; node < first[g + 1]; ++node) {
      snapshot.position.push_back(packing.position[node] + shift + 1e-3 * vector());
      snapshot.velocity.push_back(vector());
      sum += snapshot.position.back();
    }
    snapshot.grain_centre.push_back(sum / static_cast<double>(first[g + 1] - first[g]));
    snapshot.grain_stress.push_back({far(random), 1.0, 2.0, 3.0, 4.0, 5.0});
  }
  return snapshot;
}

Snapshot own_part(const Snapshot& whole, const Packing& packing, const Ranks& ranks) {
  if (!ranks.is_distributed()) {
    return whole;
  }
  Snapshot own = whole;
  own.position.clear();
  own.velocity.clear();
  std::mt19937 random(static_cast<unsigned>(whole.step) + 1000);
  const std::vector<std::int64_t> first = packing.first_nodes();
  for (int g = 0; g < packing.n_grains(); ++g) {
    if (static_cast<int>(random() % ranks.size()) == ranks.rank()) {
      own.grains.push_back(g);
      own.position.insert(own.position.end(), whole.position.begin() + first[g], whole.position.begin() + first[g + 1]);
      own.velocity.insert(own.velocity.end(), whole.velocity.begin() + first[g], whole.velocity.begin() + first[g + 1]);
    }
  }
  return own;
}

void write(char** argv, const Ranks& ranks) {
  const std::filesystem::path path = argv[1];
  const std::int64_t first = std::atoi(argv[4]), last = std::atoi(argv[5]);
  const Packing packing =
      small_packing({.box = Box({-1, -2, -3}, {20, 21, 22}, {3, -2, 1}, {true, true, true}), .n_grains = 9});
  SharedTrajectory trajectory(ranks, path, packing.first_nodes(), [&](bool nodes_by_others) {
    const Topology topology = packing.topology(true);
    if (first > 0) {
      return TrajectoryWriter::go_on(path, topology, first - 1, nodes_by_others);
    }
    return TrajectoryWriter(path, topology, {}, {std::atoi(argv[2]) != 0, std::atoi(argv[3]), nodes_by_others});
  });
  for (std::int64_t step = first; step <= last; ++step) {
    trajectory.write(own_part(frame_of(packing, step), packing, ranks));
  }
  trajectory.write(own_part(frame_of(packing, last), packing, ranks)); // offered twice
  trajectory.close();
}

} // namespace
} // namespace boba::test

int main(int argc, char** argv) {
  const boba::MessagePassing mpi;
  try {
    if (argc != 6) {
      throw std::invalid_argument("five arguments are needed");
    }
    boba::test::write(argv, mpi.ranks());
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
