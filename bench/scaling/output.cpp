// SPDX-License-Identifier: GPL-3.0-or-later
// Seconds that a trajectory frame and a checkpoint take on the ranks it is started on, and each rank's largest memory.
// The packing is a grid of grains without bonds; no step is made. Prints one line of JSON.
#include "bpm/archive/archive.h"
#include "bpm/dynamics/motion_archive.h"
#include "bpm/dynamics/share_state.h"
#include "bpm/dynamics/stepper.h"
#include "bpm/dynamics/take_snapshot.h"
#include "bpm/io/checkpoint.h"
#include "bpm/io/shared_trajectory.h"
#include "bpm/parallel/message_passing.h"
#include "bpm/parallel/share_packing.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <fstream>

namespace boba::bench {
namespace {

struct Arguments {
  int side = 4, nodes = 5137, repeats = 5;
  bool gather = false;
  std::string folder = "bench_output";
};

/// A cubic lattice, 1.2 d apart.
std::shared_ptr<const GrainTemplate> lattice(int n_nodes) {
  GrainTemplate grain;
  const int edge = static_cast<int>(std::ceil(std::cbrt(n_nodes)));
  Vector3 mean = Vector3::Zero();
  for (int i = 0; i < n_nodes; ++i) {
    grain.position.push_back(1.2 * Eigen::Vector3i(i % edge, i / edge % edge, i / edge / edge).cast<double>());
    mean += grain.position.back() / n_nodes;
  }
  for (Vector3& x : grain.position) {
    x -= mean;
  }
  grain.reference_volume = n_nodes;
  return std::make_shared<const GrainTemplate>(std::move(grain));
}

Packing grid(const Arguments& a) {
  const auto grain = lattice(a.nodes);
  const double apart = 1.2 * std::ceil(std::cbrt(a.nodes)) + 3.0;
  std::vector<Placement> placements;
  for (int g = 0; g < a.side * a.side * a.side; ++g) {
    const Eigen::Vector3i cell(g % a.side, g / a.side % a.side, g / a.side / a.side);
    placements.push_back({{}, apart * (cell.cast<double>() + Vector3::Constant(0.5))});
  }
  const Box box(Vector3::Zero(), Vector3::Constant(apart * a.side), Vector3::Zero(), {true, true, true});
  return make_packing(box, {grain}, placements);
}

/// Most memory this process has had, MB.
double peak_memory() {
  std::ifstream in("/proc/self/status");
  for (std::string word; in >> word;) {
    if (word == "VmHWM:") {
      double kilobytes = 0.0;
      in >> kilobytes;
      return kilobytes / 1024.0;
    }
  }
  return 0.0;
}

template <class Work> double median_seconds(int repeats, const Ranks& ranks, const Work& work) {
  std::vector<double> seconds;
  for (int k = 0; k < repeats; ++k) {
    ranks.largest(0.0); // all begin together
    const auto begin = std::chrono::steady_clock::now();
    work(k);
    seconds.push_back(ranks.largest(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()));
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

double frame_seconds(const Arguments& a, const Stepper& stepper) {
  const Ranks& ranks = stepper.ranks();
  const std::filesystem::path path = std::filesystem::path(a.folder) / "trajectory.h5";
  const auto open = [&](bool by_others) {
    const TrajectoryOptions options{true, 0, by_others};
    return TrajectoryWriter(path, stepper.packing().topology(true), {}, options, FileMode::overwrite);
  };
  if (!a.gather) {
    SharedTrajectory trajectory(ranks, path, stepper.packing().first_nodes(), open);
    const double seconds = median_seconds(a.repeats, ranks, [&](int k) {
      Snapshot own = take_snapshot(stepper.moving(), {.velocity = true, .own = true});
      own.step = k;
      trajectory.write(own);
    });
    trajectory.close();
    return seconds;
  }
  std::optional<TrajectoryWriter> writer;
  if (ranks.is_root()) {
    writer.emplace(open(false));
  }
  return median_seconds(a.repeats, ranks, [&](int k) {
    Snapshot whole = take_snapshot(stepper.moving(), {.velocity = true});
    whole.step = k;
    if (writer) {
      writer->write(whole);
    }
  });
}

double checkpoint_seconds(const Arguments& a, Stepper& stepper) {
  const std::vector<std::int64_t> first_node = stepper.packing().first_nodes();
  return median_seconds(a.repeats, stepper.ranks(), [&](int) {
    SavedState state;
    Archive archive = Archive::saving_to(state);
    archive.inside("simulation", [&] { archive_motion(archive, stepper.moving()); });
    write_checkpoint(a.folder, state, stepper.ranks(),
                     {{node_fields.begin(), node_fields.end()},
                      node_runs(stepper.layout().grains(), first_node),
                      first_node.back()});
  });
}

void run(const Arguments& a, const Ranks& ranks) {
  std::filesystem::create_directories(a.folder);
  Packing packing;
  if (ranks.is_root()) {
    packing = grid(a);
  }
  share_packing(packing, ranks);
  Stepper stepper(std::move(packing), Material{}, {.threads = 1, .ranks = &ranks});
  stepper.start();
  const double before = ranks.largest(peak_memory());
  const double frame = frame_seconds(a, stepper), of_frames = peak_memory();
  const double others_of_frames = ranks.largest(ranks.is_root() ? 0.0 : of_frames);
  const double checkpoint = checkpoint_seconds(a, stepper), in_all = peak_memory();
  const double others_in_all = ranks.largest(ranks.is_root() ? 0.0 : in_all);
  if (ranks.is_root()) {
    fmt::print("{{\"ranks\": {}, \"nodes\": {}, \"gather\": {}, \"frame_s\": {:.4f}, \"checkpoint_s\": {:.4f}, "
               "\"start_MB\": {:.0f}, \"root_after_frames_MB\": {:.0f}, \"others_after_frames_MB\": {:.0f}, "
               "\"root_MB\": {:.0f}, \"others_MB\": {:.0f}}}\n",
               ranks.size(), stepper.packing().first_nodes().back(), a.gather, frame, checkpoint, before, of_frames,
               others_of_frames, in_all, others_in_all);
  }
}

} // namespace
} // namespace boba::bench

int main(int argc, char** argv) {
  boba::bench::Arguments a;
  CLI::App app("Time of a frame and a checkpoint on several ranks; start it with mpirun.");
  app.add_option("--side", a.side, "grains along an edge")->capture_default_str();
  app.add_option("--nodes", a.nodes, "a grain")->capture_default_str();
  app.add_option("--repeats", a.repeats, "of which the median is taken")->capture_default_str();
  app.add_option("--folder", a.folder, "for the files")->capture_default_str();
  app.add_flag("--gather", a.gather, "frames are gathered and written by rank 0");
  CLI11_PARSE(app, argc, argv);
  const boba::MessagePassing mpi;
  boba::bench::run(a, mpi.ranks());
}
