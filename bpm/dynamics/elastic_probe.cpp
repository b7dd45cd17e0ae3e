// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/elastic_probe.h"

#include "bpm/dynamics/scoped_threads.h"

#include <cmath>

namespace boba {

namespace {

std::vector<Vector3> positions_of(const MovingPacking& moving) {
  std::vector<Vector3> x;
  for (const int g : moving.layout.grains()) {
    for (int node = 0; node < moving.layout.n_nodes(g); ++node) {
      x.push_back(moving.state.position(g, node));
    }
  }
  return x;
}

/// Places the nodes, which were at x, and evaluates them in a cell that is larger by `factor` in length.
double virial_pressure_when_scaled(MovingPacking& moving, const std::vector<Vector3>& x, double factor) {
  const Box& box = moving.cell.box();
  const Matrix3 map = factor * moving.cell.position_map();
  const Vector3 shift = box.origin() - map * box.origin();
  std::size_t next = 0;
  for (const int g : moving.layout.grains()) {
    for (int node = 0; node < moving.layout.n_nodes(g); ++node) {
      moving.state.set_position(g, node, map * x[next++] + shift);
    }
  }
  Box scaled_box = box;
  scaled_box.set_h(factor * box.h());
  moving.forces.contact_list().invalidate();
  moving.forces.evaluate(moving.state, scaled_box,
                         {.virial = Virial::trace, .is_trial = true, .residual_rate = moving.cell.residual_rate()});
  moving.forces.share_sums(Virial::trace);
  double virial = 0.0;
  for (const GrainSums& grain : moving.forces.grain_sums()) {
    virial += grain.virial_trace;
  }
  return virial / (3.0 * scaled_box.volume());
}

} // namespace

double affine_bulk_modulus(MovingPacking& moving) {
  const ScopedThreads threads(moving.options.threads);
  const LaneState before = moving.state;
  const std::vector<Vector3> x = positions_of(moving);
  const ForceField::Results results = moving.forces.results();
  const Walls walls = moving.forces.walls();
  const double step = 1e-5;
  const double looser = virial_pressure_when_scaled(moving, x, 1.0 + step);
  const double tighter = virial_pressure_when_scaled(moving, x, 1.0 - step);
  // Nothing of the state has moved but these; the list of the next step is built from scratch and gives the same
  // forces.
  moving.state.take(before);
  moving.forces.set_results(results);
  moving.forces.walls() = walls;
  moving.forces.contact_list().invalidate();
  return (tighter - looser) / (6.0 * step);
}

double sound_crossing(const MovingPacking& moving, double bulk_modulus) {
  const double mass = moving.n_nodes() * moving.material.node_mass;
  const double speed = std::sqrt(bulk_modulus * moving.cell.box().volume() / mass);
  return moving.cell.box().lengths().minCoeff() / speed;
}

} // namespace boba
