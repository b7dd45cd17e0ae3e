// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/elastic_probe.h"

#include "bpm/dynamics/scoped_threads.h"
#include "bpm/packing/cell_components.h"

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

struct Virial6 {
  double trace = 0.0;
  std::array<double, 6> component{};
  double volume = 0.0; ///< d^3
};

/// Places the nodes, which were at x, and evaluates them in a cell that is deformed by `deformation`.
Virial6 virial_when_deformed(MovingPacking& moving, const std::vector<Vector3>& x, const Matrix3& deformation,
                             Virial what) {
  const Box& box = moving.cell.box();
  const Matrix3 map = deformation * moving.cell.position_map();
  const Vector3 shift = box.origin() - map * box.origin();
  std::size_t next = 0;
  for (const int g : moving.layout.grains()) {
    for (int node = 0; node < moving.layout.n_nodes(g); ++node) {
      moving.state.set_position(g, node, map * x[next++] + shift);
    }
  }
  Box deformed = box;
  deformed.set_h(deformation * box.h());
  moving.forces.forget_contacts();
  moving.forces.evaluate(moving.state, deformed,
                         {.virial = what, .is_trial = true, .residual_rate = moving.cell.residual_rate()});
  moving.forces.share_sums(what);
  Virial6 sum;
  sum.volume = deformed.volume();
  for (const GrainSums& grain : moving.forces.grain_sums()) {
    sum.trace += grain.virial_trace;
    for (int c = 0; c < 6; ++c) {
      sum.component[c] += grain.virial[c];
    }
  }
  return sum;
}

struct Probe {
  Virial6 larger, smaller;
};

/// Evaluates the packing at 1 + step and 1 - step times the displacement gradient, and leaves it as it was.
Probe probe(MovingPacking& moving, const Matrix3& gradient, double step, Virial what) {
  const ScopedThreads threads(moving.options.threads);
  const LaneState before = moving.state;
  const std::vector<Vector3> x = positions_of(moving);
  const ForceSums sums = moving.forces.sums();
  const Walls walls = moving.forces.walls();
  Probe probe;
  probe.larger = virial_when_deformed(moving, x, Matrix3::Identity() + step * gradient, what);
  probe.smaller = virial_when_deformed(moving, x, Matrix3::Identity() - step * gradient, what);
  // Nothing of the state has moved but these; the list of the next step is built from scratch and gives the same
  // forces.
  moving.state.take(before);
  moving.forces.set_sums(sums);
  moving.forces.walls() = walls;
  moving.forces.forget_contacts();
  return probe;
}

constexpr double probe_strain = 1e-5;

} // namespace

double affine_bulk_modulus(MovingPacking& moving) {
  const auto [looser, tighter] = probe(moving, Matrix3::Identity(), probe_strain, Virial::trace);
  return (tighter.trace / (3.0 * tighter.volume) - looser.trace / (3.0 * looser.volume)) / (6.0 * probe_strain);
}

double affine_stiffness(MovingPacking& moving, int c) {
  Matrix3 gradient = Matrix3::Zero();
  gradient(component_place[c][0], component_place[c][1]) = 1.0;
  const auto [larger, smaller] = probe(moving, gradient, probe_strain, Virial::full);
  return (smaller.component[c] / smaller.volume - larger.component[c] / larger.volume) / (2.0 * probe_strain);
}

double sound_crossing(const MovingPacking& moving, double bulk_modulus) {
  const double mass = moving.n_nodes() * moving.material.node_mass;
  const double speed = std::sqrt(bulk_modulus * moving.cell.box().volume() / mass);
  return moving.cell.box().lengths().minCoeff() / speed;
}

} // namespace boba
