// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/bond_survey.h"

#include <algorithm>
#include <cmath>

namespace boba {

namespace {

bool is_whole(const LaneLayout& layout, const LaneState& state, int grain, std::int64_t bond) {
  return !layout.remembers(grain) || state.bond_memory(grain, bond, 0) > 0.0;
}

struct SurveyedBond {
  int node;               ///< the first
  double r, r0;           ///< d
  std::int64_t bond = -1; ///< its number in the template; -1: across the boundary
};

/// Calls visit(bond) for every whole bond of a grain, those across the boundary included.
template <class Visit>
void for_each_bond(const NetworkData& data, const LaneLayout& layout, const LaneState& state, const Box& box, int grain,
                   Visit&& visit) {
  const kernels::Network network = data.view();
  for (int i = 0; i < network.n_nodes; ++i) {
    const Vector3 xi = state.position(grain, i);
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      if (is_whole(layout, state, grain, b)) {
        visit(SurveyedBond{i, (xi - state.position(grain, network.bonds[b].other)).norm(), network.bonds[b].r0, b});
      }
    }
  }
  for (const ImageBond& bond : data.image_bonds()) {
    const Vector3 d = state.position(grain, bond.i) - state.position(grain, bond.j);
    visit(SurveyedBond{bond.i, (d - box.h() * bond.n.cast<double>()).norm(), bond.r0});
  }
}

/// Per node of a grain: how many bonds its network gives it.
std::vector<int> bonds_of_nodes(const NetworkData& data) {
  const kernels::Network network = data.view();
  std::vector<int> n_bonds(network.n_nodes, 0);
  for (int i = 0; i < network.n_nodes; ++i) {
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      ++n_bonds[i];
      ++n_bonds[network.bonds[b].other];
    }
  }
  for (const ImageBond& bond : data.image_bonds()) {
    ++n_bonds[bond.i];
    ++n_bonds[bond.j];
  }
  return n_bonds;
}

} // namespace

std::vector<kernels::NodePair> broken_bonds(const NetworkData& data, const LaneLayout& layout, const LaneState& state,
                                            int grain) {
  const kernels::Network network = data.view();
  std::vector<kernels::NodePair> broken;
  for (int i = 0; layout.remembers(grain) && i < network.n_nodes; ++i) {
    for (std::int64_t b = network.first_bond[i]; b < network.first_bond[i + 1]; ++b) {
      if (!is_whole(layout, state, grain, b)) {
        broken.push_back({i, network.bonds[b].other});
      }
    }
  }
  return broken;
}

double BondSurvey::energy(const Box& box) const {
  std::vector<double> energy(layout_.n_grains(), 0.0);
#pragma omp parallel for schedule(dynamic, 8)
  for (const int g : layout_.grains()) {
    const Block& block = layout_.blocks()[layout_.block_of(g)];
    const BreakingBondLaw breaking{law_, block.breaking.in_tension_only, block.breaking.smooth};
    const YieldingBondLaw yielding{breaking, block.yielding.strain, block.yielding.hardening};
    for_each_bond(*network_of_grain_[g], layout_, state_, box, g, [&](const SurveyedBond& bond) {
      double memory[YieldingBondLaw::n_remembered] = {};
      for (int k = 0; k < layout_.n_remembered(g); ++k) {
        memory[k] = state_.bond_memory(g, bond.bond, k);
      }
      const double limit[] = {memory[0]};
      energy[g] += block.yielding.is_possible()   ? yielding.energy(bond.r, bond.r0, memory)
                   : block.breaking.is_possible() ? breaking.energy(bond.r, bond.r0, limit)
                                                  : law_.energy(bond.r, bond.r0);
    });
  }
  distribution_.ranks->share_rows(energy, 1, distribution_.ownership);
  double total = 0.0;
  for (const double e : energy) { // grain by grain: the same sum for any number of threads
    total += e;
  }
  return total;
}

std::vector<int> BondSurvey::whole_bonds(int grain) const {
  std::vector<int> n_whole = bonds_of_nodes(*network_of_grain_[grain]);
  for (const kernels::NodePair& pair : broken_bonds(*network_of_grain_[grain], layout_, state_, grain)) {
    --n_whole[pair.i];
    --n_whole[pair.j];
  }
  return n_whole;
}

std::vector<double> BondSurvey::damage(int grain) const {
  const std::vector<int> n_bonds = bonds_of_nodes(*network_of_grain_[grain]);
  std::vector<double> damage(n_bonds.size(), 0.0);
  for (const kernels::NodePair& pair : broken_bonds(*network_of_grain_[grain], layout_, state_, grain)) {
    damage[pair.i] += 1.0;
    damage[pair.j] += 1.0;
  }
  for (std::size_t i = 0; i < damage.size(); ++i) {
    damage[i] /= std::max(1, n_bonds[i]);
  }
  return damage;
}

std::int64_t BondSurvey::n_broken() const {
  std::int64_t n = 0;
  for (const int g : layout_.grains()) {
    n += static_cast<std::int64_t>(broken_bonds(*network_of_grain_[g], layout_, state_, g).size());
  }
  return distribution_.ranks->sum(n);
}

double BondSurvey::plastic_strain() const {
  std::vector<double> sums(2 * static_cast<std::size_t>(layout_.n_grains()), 0.0); // of p, and bonds, per grain
  for (const int g : layout_.grains()) {
    if (layout_.n_remembered(g) == YieldingBondLaw::n_remembered) {
      const std::int64_t n_bonds = layout_.first_bonds(g).back();
      for (std::int64_t b = 0; b < n_bonds; ++b) {
        sums[2 * g] += state_.bond_memory(g, b, 2);
      }
      sums[2 * g + 1] = static_cast<double>(n_bonds);
    }
  }
  distribution_.ranks->share_rows(sums, 2, distribution_.ownership);
  double plastic = 0.0, bonds = 0.0;
  for (std::size_t row = 0; row < sums.size(); row += 2) {
    plastic += sums[row];
    bonds += sums[row + 1];
  }
  return bonds > 0.0 ? plastic / bonds : 0.0;
}

Stretch BondSurvey::largest_stretch(const Box& box) const {
  std::vector<Stretch> largest(layout_.n_grains());
#pragma omp parallel for schedule(dynamic, 8)
  for (const int g : layout_.grains()) {
    for_each_bond(*network_of_grain_[g], layout_, state_, box, g, [&](const SurveyedBond& bond) {
      if (!(bond.r / bond.r0 <= largest[g].ratio)) { // also true for NaN
        largest[g] = {bond.r / bond.r0, g, bond.node};
      }
    });
  }
  return *std::max_element(largest.begin(), largest.end(), [](const Stretch& a, const Stretch& b) {
    return a.ratio < b.ratio || (!std::isnan(a.ratio) && std::isnan(b.ratio));
  });
}

} // namespace boba
