// SPDX-License-Identifier: GPL-3.0-or-later
// Time of a step of a dense shear on the ranks it is started on, what the ranks tell each other, and what they would on
// more; time of measuring a frame. Prints one line of JSON. The packing is that of bench_engine, 16 grains of 5137
// nodes, repeated.
#include "bench/engine/dense_packing.h"
#include "bench/scaling/count_halo.h"
#include "bench/scaling/processor_time.h"
#include "bench/scaling/repeat_packing.h"
#include "bench/scaling/time_frame.h"
#include "bpm/parallel/message_passing.h"
#include "bpm/parallel/share_packing.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <fmt/format.h>

namespace boba::bench {
namespace {

struct Arguments {
  int grains = 16, nodes = 5137, steps = 200, threads = 1;
  double alpha = 2.0;
  std::array<int, 3> times = {1, 1, 1};
  bool mixed = false;
  int frames = 0;
  std::vector<int> count;
};

Packing packing_of(const Arguments& a, const Ranks& ranks) {
  Packing packing;
  ranks.collectively([&] {
    if (ranks.is_root()) {
      packing = repeated(dense_packing(a.grains, a.nodes, a.alpha), a.times);
    }
  });
  share_packing(packing, ranks);
  return packing;
}

void run(const Arguments& a, const Ranks& ranks) {
  Stepper stepper(packing_of(a, ranks), Material{},
                  {.threads = a.threads, .precision = a.mixed ? Precision::mixed : Precision::full, .ranks = &ranks});
  const double pressure = dense_pressure(a.alpha);
  const auto step = [&] {
    stepper.advance(Virial::trace);
    stepper.move_cell(dense_shear_rates(stepper.pressure() - pressure));
  };
  stepper.start();
  for (int warm = 0; warm < 20; ++warm) {
    step();
  }
  const Timings before = timings_of(stepper.moving());
  const double processor_before = processor_seconds();
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < a.steps; ++k) {
    step();
  }
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / a.steps;
  const Timings t = timings_of(stepper.moving());
  const double n_steps = a.steps;
  double largest[] = {processor_seconds() - processor_before,
                      t.bonds - before.bonds + t.contacts - before.contacts + t.search - before.search + t.integration -
                          before.integration,
                      t.halo - before.halo,
                      t.reductions - before.reductions,
                      static_cast<double>(t.halo_bytes - before.halo_bytes),
                      static_cast<double>(t.halo_messages - before.halo_messages)};
  ranks.largest(largest);
  const std::string frame = a.frames > 0 ? fmt::format(", \"frame\": {}", time_frame(stepper, ranks, a.frames)) : "";
  if (!ranks.is_root()) {
    return;
  }
  const double n_nodes = static_cast<double>(stepper.packing().position.size());
  fmt::print(
      "{{\"ranks\": {}, \"threads\": {}, \"grains\": {}, \"nodes\": {}, \"alpha\": {}, \"mixed\": {}, \"steps\": {}, "
      "\"ms_a_step\": {:.4f}, \"node_steps_per_s\": {:.4g}, \"processor_ms\": {:.4f}, \"work_ms\": {:.4f}, "
      "\"search_ms\": {:.4f}, \"halo_ms\": {:.4f}, \"reduction_ms\": {:.4f}, \"halo_bytes_a_step\": {:.0f}, "
      "\"halo_messages_a_step\": {:.2f}, \"halos_a_step\": {:.4f}, \"bytes_a_node\": {:.0f}",
      ranks.size(), a.threads, stepper.packing().n_grains(), n_nodes, a.alpha, a.mixed, a.steps, 1e3 * wall,
      n_nodes / wall, 1e3 * largest[0] / n_steps, 1e3 * largest[1] / n_steps,
      1e3 * (t.search - before.search) / n_steps, 1e3 * largest[2] / n_steps, 1e3 * largest[3] / n_steps,
      largest[4] / n_steps, largest[5] / n_steps, static_cast<double>(t.halo_builds - before.halo_builds) / n_steps,
      static_cast<double>(bytes_of(stepper.moving())) / (n_nodes / ranks.size()));
  for (std::size_t k = 0; k < a.count.size(); ++k) {
    const HaloCount c = count_halo(stepper, a.count[k]);
    fmt::print(
        "{}{{\"ranks\": {}, \"imbalance\": {:.3f}, \"messages\": {:.2f}, \"nodes\": {:.0f}, \"most_nodes\": {:.0f}, "
        "\"ghosts\": {:.1f}}}",
        k == 0 ? ", \"counted\": [" : ", ", c.n_ranks, c.imbalance, c.mean_messages, c.mean_nodes, c.most_nodes,
        c.mean_ghosts);
  }
  fmt::print("{}{}}}\n", a.count.empty() ? "" : "]", frame);
}

} // namespace
} // namespace boba::bench

int main(int argc, char** argv) {
  boba::bench::Arguments a;
  CLI::App app("Time of a step on several ranks; start it with mpirun.");
  app.add_option("--grains", a.grains, "of the packing that is repeated")->capture_default_str();
  app.add_option("--nodes", a.nodes, "a grain")->capture_default_str();
  app.add_option("--alpha", a.alpha, "0 or 2")->capture_default_str();
  app.add_option("--times", a.times, "repeats along the three cell vectors")->capture_default_str();
  app.add_option("--steps", a.steps, "timed")->capture_default_str();
  app.add_option("--frames", a.frames, "measured too, timed by their best; 0: none")->capture_default_str();
  app.add_option("--threads", a.threads, "of a rank")->capture_default_str();
  app.add_flag("--mixed", a.mixed, "mixed precision");
  app.add_option("--count", a.count, "on one rank: count the halo on so many ranks");
  CLI11_PARSE(app, argc, argv);
  const boba::MessagePassing mpi;
  boba::bench::run(a, mpi.ranks());
}
