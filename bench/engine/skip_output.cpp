// SPDX-License-Identifier: GPL-3.0-or-later
// What a run need not look at or write: the same dense shear with frames, and with nobody asking.
#include "bench/engine/count_node_steps.h"
#include "bench/engine/dense_packing.h"
#include "bench/engine/skips.h"
#include "bpm/app/write_behind.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/io/lammps_dump.h"
#include "bpm/io/trajectory.h"

#include <filesystem>

namespace boba::bench {
namespace {

enum class Output { nothing, trajectory, dump };
/// Who writes: the run itself, which waits, or a thread of its own, for which the run waits before the next frame.
enum class Writes { run, thread };

constexpr int steps = 200, interval = 20;

void step(benchmark::State& state, Output output, Writes writes, int threads) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "boba_bench_output";
  std::filesystem::create_directories(folder);
  Stepper stepper(dense_packing(16, 5137, 2.0), Material{}, SimulationOptions{.threads = threads});
  const Topology topology = stepper.packing().topology(true);
  TrajectoryWriter trajectory(folder / "trajectory.h5", topology, {}, {}, FileMode::overwrite);
  LammpsDumpWriter dump(folder / "dump.lammpstrj", DumpLayout::viewer, FileMode::overwrite);
  const auto write = [&](const Snapshot& frame) {
    output == Output::dump ? dump.write(topology, frame) : trajectory.write(frame);
  };
  WriteBehind behind(write);
  stepper.start();
  for (auto _ : state) {
    const bool wanted = output != Output::nothing && (stepper.step() + 1) % interval == 0;
    stepper.advance(wanted ? Virial::full : Virial::trace);
    if (wanted) {
      Snapshot frame = take_snapshot(stepper.moving(), {.velocity = output == Output::dump});
      if (writes == Writes::run) {
        write(frame);
      } else {
        behind.add(std::move(frame));
      }
    }
    stepper.move_cell(dense_shear_rates(0.0));
  }
  behind.wait();
  count_node_steps(state, stepper);
  trajectory.close();
  std::filesystem::remove_all(folder);
}

const bool added = [] {
  for (const int threads : {1, 2}) {
    const std::string of = "/threads:" + std::to_string(threads);
    const auto add = [&](const std::string& name, Output output, Writes writes) {
      register_skip(name + of, steps, [=](benchmark::State& state) { step(state, output, writes, threads); });
    };
    add("frame_every_20_steps/without", Output::nothing, Writes::run);
    add("frame_every_20_steps/with", Output::trajectory, Writes::run);
    add("frame_every_20_steps/with_own_thread", Output::trajectory, Writes::thread);
    add("text_dump_every_20_steps/with", Output::dump, Writes::run);
    add("text_dump_every_20_steps/with_own_thread", Output::dump, Writes::thread);
  }
  return true;
}();

} // namespace
} // namespace boba::bench
