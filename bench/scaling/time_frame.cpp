// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/scaling/time_frame.h"

#include "bench/scaling/processor_time.h"
#include "bpm/app/measure/frame_measures.h"
#include "bpm/dynamics/take_snapshot.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <limits>

namespace boba::bench {

namespace {

/// Best of `n` calls, as JSON.
template <class Work> std::string best_of(int n, const Ranks& ranks, const Work& work) {
  double wall = std::numeric_limits<double>::infinity(), processor = wall;
  for (int k = 0; k < n; ++k) {
    ranks.any(false); // all begin together
    const double processor_before = processor_seconds();
    const auto begin = std::chrono::steady_clock::now();
    work();
    double largest[] = {std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(),
                        processor_seconds() - processor_before};
    ranks.largest(largest);
    wall = std::min(wall, largest[0]);
    processor = std::min(processor, largest[1]);
  }
  return fmt::format("{{\"seconds\": {:.4f}, \"processor\": {:.4f}}}", wall, processor);
}

} // namespace

std::string time_frame(const Stepper& stepper, const Ranks& ranks, int n_frames) {
  const Topology topology = stepper.packing().topology(false);
  const Simulation::Parts parts = {.positions_on_all_ranks = true};
  const Snapshot snapshot = take_snapshot(stepper.moving(), parts);
  const auto measured = [&](const std::vector<std::string>& names) {
    MeasurePlan plan;
    choose_measures(plan, names);
    plan.facet_sensitivity = true;
    plan.neighbours = NeighbourRule::voronoi;
    return best_of(n_frames, ranks,
                   [&] { measure_together(snapshot.box, snapshot.position, topology.first_node, plan, ranks); });
  };
  std::string json = fmt::format("{{\"all\": {}", measured({"all"}));
  for (const char* name : {"packing-fraction", "shape", "scattering", "contacts"}) {
    json += fmt::format(", \"{}\": {}", name, measured({name}));
  }
  return json +
         fmt::format(", \"snapshot\": {}}}", best_of(n_frames, ranks, [&] { take_snapshot(stepper.moving(), parts); }));
}

} // namespace boba::bench
