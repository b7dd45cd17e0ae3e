// SPDX-License-Identifier: GPL-3.0-or-later
// Passes over all bonds that are taken now and then, in plain scalars.
#include "bpm/forces/force_field.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

/// Calls visit(first node, length, undeformed length) for every bond of a grain, those across the boundary included.
template <class Visit>
void for_each_bond(const NetworkData& data, const LaneState& state, const Box& box, int grain, Visit&& visit) {
  const kernels::Network network = data.view();
  for (int i = 0; i < network.n_nodes; ++i) {
    const Vector3 xi = state.position(grain, i);
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      visit(i, (xi - state.position(grain, network.bonds[b].other)).norm(), network.bonds[b].r0);
    }
  }
  for (const ImageBond& bond : data.image_bonds()) {
    const Vector3 d = state.position(grain, bond.i) - state.position(grain, bond.j);
    visit(bond.i, (d - box.h() * bond.n.cast<double>()).norm(), bond.r0);
  }
}

} // namespace

double ForceField::bond_energy(const LaneState& state, const Box& box) const {
  const BondLaw law = bond_law(material_);
  std::vector<double> energy(layout_.n_grains(), 0.0);
#pragma omp parallel for schedule(dynamic, 8)
  for (const int g : layout_.grains()) {
    for_each_bond(*network_of_grain_[g], state, box, g,
                  [&](int, double r, double r0) { energy[g] += law.energy(r, r0); });
  }
  distribution_.ranks->share_rows(energy, 1, distribution_.ownership);
  double total = 0.0;
  for (const double e : energy) { // grain by grain: the same sum for any number of threads
    total += e;
  }
  return total;
}

ForceField::Stretch ForceField::largest_stretch(const LaneState& state, const Box& box) const {
  std::vector<Stretch> largest(layout_.n_grains());
#pragma omp parallel for schedule(dynamic, 8)
  for (const int g : layout_.grains()) {
    for_each_bond(*network_of_grain_[g], state, box, g, [&](int node, double r, double r0) {
      if (!(r / r0 <= largest[g].ratio)) { // also true for NaN
        largest[g] = {r / r0, g, node};
      }
    });
  }
  return *std::max_element(largest.begin(), largest.end(), [](const Stretch& a, const Stretch& b) {
    return a.ratio < b.ratio || (!std::isnan(a.ratio) && std::isnan(b.ratio));
  });
}

} // namespace boba
