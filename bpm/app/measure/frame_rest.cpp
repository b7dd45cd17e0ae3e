// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/frame_rest.h"

#include "bpm/dynamics/simulation.h"
#include "bpm/measure/grain_nodes.h"
#include "bpm/stages/hold.h"

#include <fmt/format.h>
#include <omp.h>
#include <stdexcept>
#include <utility>

namespace boba {

FrameRest::FrameRest(Packing packing, const Material& material, double dt, double time)
    : packing_(std::move(packing)), material_(material), dt_(dt), time_(time) {}

std::vector<Vector3> FrameRest::rested_centres(const Snapshot& snapshot) const {
  const std::vector<std::int64_t> first_node = packing_.first_nodes();
  if (static_cast<std::int64_t>(snapshot.position.size()) != first_node.back()) {
    throw std::invalid_argument(
        fmt::format("rest of a frame: {} nodes, but the packing has {}", snapshot.position.size(), first_node.back()));
  }
  Packing copy = packing_;
  copy.box = snapshot.box;
  copy.position = snapshot.position;
  copy.velocity.assign(snapshot.position.size(), Vector3::Zero());
  SimulationOptions options;
  options.dt = dt_;
  options.threads = omp_get_max_threads();
  Simulation simulation(std::move(copy), material_, options);
  simulation.run(0, HoldDriver({.time = time_, .barostat = {}}), {});
  const Snapshot rested = simulation.snapshot();
  return measure::grain_centres(measure::GrainNodes(rested.position, first_node));
}

} // namespace boba
