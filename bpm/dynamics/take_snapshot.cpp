// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/take_snapshot.h"

#include "bpm/dynamics/node_exchange.h"

#include <stdexcept>
#include <string>

namespace boba {

double least_pressure(Precision precision) {
  return precision == Precision::full ? 1e-12 : 1e-8;
}

std::array<double, 6> stress_of(const MovingPacking& moving) {
  std::array<double, 6> stress{};
  const double volume = moving.cell.evaluated_box().volume();
  for (const GrainSums& grain : moving.forces.grain_sums()) {
    for (int c = 0; c < 6; ++c) {
      stress[c] -= (grain.virial[c] + grain.kinetic[c]) / volume;
    }
  }
  return stress;
}

Totals totals_of(const MovingPacking& moving) {
  Totals totals;
  totals.stress = stress_of(moving);
  totals.pressure = moving.pressure;
  totals.least_pressure = least_pressure(moving.options.precision);
  totals.kinetic_energy = moving.kinetic_energy;
  const ContactTotals contacts = moving.forces.contact_totals();
  totals.elastic_energy = moving.bond_energy() + contacts.energy;
  totals.largest_overlap = contacts.largest_overlap;
  if (moving.forces.bonds().can_break()) {
    totals.n_broken_bonds = moving.forces.survey(moving.state).n_broken();
  }
  if (moving.forces.bonds().can_yield()) {
    totals.plastic_strain = moving.forces.survey(moving.state).plastic_strain();
  }
  return totals;
}

namespace {

/// This rank's nodes, grain by grain, and the centres of its grains.
void add_own_nodes(const MovingPacking& moving, Simulation::Parts parts, Snapshot& snapshot) {
  const double back = moving.started ? -0.5 * moving.options.dt / moving.material.node_mass : 0.0;
  snapshot.grain_centre.assign(moving.layout.n_grains(), Vector3::Zero());
  for (const int g : moving.layout.grains()) {
    Vector3& centre = snapshot.grain_centre[g];
    for (int node = 0; node < moving.layout.n_nodes(g); ++node) {
      snapshot.position.push_back(moving.state.position(g, node));
      centre += snapshot.position.back();
      if (parts.velocity) {
        snapshot.velocity.push_back(moving.state.velocity(g, node) + back * moving.state.force(g, node));
      }
      if (parts.force) {
        snapshot.force.push_back(moving.state.force(g, node));
      }
    }
    centre /= moving.layout.n_nodes(g);
  }
}

void gather_parts(const MovingPacking& moving, Simulation::Parts parts, Snapshot& snapshot) {
  gather_nodes(moving, snapshot.position);
  if (parts.positions_on_all_ranks) {
    moving.ranks().broadcast(snapshot.position);
  }
  if (parts.velocity) {
    gather_nodes(moving, snapshot.velocity);
  }
  if (parts.force) {
    gather_nodes(moving, snapshot.force);
  }
}

void add_damage(const MovingPacking& moving, Snapshot& snapshot) {
  for (const int g : moving.layout.grains()) {
    const std::vector<double> of_grain = moving.forces.survey(moving.state).damage(g);
    snapshot.damage.insert(snapshot.damage.end(), of_grain.begin(), of_grain.end());
  }
  gather_rows(moving, 1, snapshot.damage);
}

void add_grain_stress(const MovingPacking& moving, Snapshot& snapshot) {
  for (const GrainSums& sums : moving.forces.grain_sums()) {
    std::array<double, 6> stress;
    for (int c = 0; c < 6; ++c) {
      stress[c] = -(sums.virial[c] + sums.kinetic[c]);
    }
    snapshot.grain_stress.push_back(stress);
  }
}

} // namespace

Snapshot take_snapshot(const MovingPacking& moving, Simulation::Parts parts) {
  if ((parts.force || (parts.velocity && moving.started)) && !moving.forces_kept) {
    throw std::logic_error("snapshot: the forces of step " + std::to_string(moving.step) +
                           " were not kept; an observer must ask for it");
  }
  Snapshot snapshot;
  snapshot.step = moving.step;
  snapshot.time = moving.time();
  snapshot.strain = moving.cell.strain();
  snapshot.box = moving.cell.evaluated_box();
  snapshot.streaming_rate = moving.cell.streaming()(0, 1);
  add_own_nodes(moving, parts, snapshot);
  if (parts.own && moving.ranks().is_distributed()) {
    snapshot.grains = moving.layout.grains();
  } else {
    gather_parts(moving, parts, snapshot);
  }
  if (moving.forces.bonds().can_break()) {
    add_damage(moving, snapshot);
  }
  share_grains(moving, snapshot.grain_centre);
  add_grain_stress(moving, snapshot);
  return snapshot;
}

} // namespace boba
