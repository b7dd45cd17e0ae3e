// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/bond_order.h"

#include "bpm/measure/spherical_harmonics.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::measure {

namespace {

void check(const NeighbourLists& neighbours, const BondOrderOptions& options) {
  if (!(options.solid_bond_cosine > -1.0 && options.solid_bond_cosine < 1.0)) {
    throw std::invalid_argument(
        fmt::format("bond order: solid_bond_cosine is {}; it must lie between -1 and 1", options.solid_bond_cosine));
  }
  for (const auto& list : neighbours) {
    for (const Neighbour& neighbour : list) {
      if (neighbour.grain < 0 || neighbour.grain >= static_cast<int>(neighbours.size())) {
        throw std::invalid_argument(
            fmt::format("bond order: a neighbour list names grain {} of {}", neighbour.grain, neighbours.size()));
      }
    }
  }
}

/// q_lm of every grain from its own neighbours.
template <int l> std::vector<Harmonics<l>> local_harmonics(const NeighbourLists& neighbours) {
  std::vector<Harmonics<l>> q(neighbours.size());
  for (std::size_t grain = 0; grain < neighbours.size(); ++grain) {
    double total = 0.0;
    for (const Neighbour& neighbour : neighbours[grain]) {
      const Harmonics<l> y = spherical_harmonics<l>(neighbour.vector);
      total += neighbour.weight;
      for (std::size_t m = 0; m < y.size(); ++m) {
        q[grain][m] += neighbour.weight * y[m];
      }
    }
    for (auto& component : q[grain]) {
      component = total > 0.0 ? component / total : 0.0;
    }
  }
  return q;
}

/// Mean over the grain itself and its neighbours.
template <int l>
Harmonics<l> averaged(const std::vector<Harmonics<l>>& q, int grain, const NeighbourLists& neighbours) {
  Harmonics<l> mean = q[grain];
  for (const Neighbour& neighbour : neighbours[grain]) {
    for (std::size_t m = 0; m < mean.size(); ++m) {
      mean[m] += q[neighbour.grain][m];
    }
  }
  for (auto& component : mean) {
    component /= 1.0 + static_cast<double>(neighbours[grain].size());
  }
  return mean;
}

double correlation(const Harmonics<6>& a, const Harmonics<6>& b) {
  double product = 0.0, norm_a = 0.0, norm_b = 0.0;
  for (std::size_t m = 0; m < a.size(); ++m) {
    product += (a[m] * std::conj(b[m])).real();
    norm_a += std::norm(a[m]);
    norm_b += std::norm(b[m]);
  }
  return norm_a > 0.0 && norm_b > 0.0 ? product / std::sqrt(norm_a * norm_b) : 0.0;
}

CrystalClass classify(const BondOrder& order, bool among_own_copies, const BondOrderOptions& options) {
  if (among_own_copies) {
    return CrystalClass::unknown;
  }
  if (order.n_solid_bonds < options.min_solid_bonds) {
    return CrystalClass::disordered;
  }
  if (order.averaged_w6 > 0.0) {
    return CrystalClass::bcc;
  }
  return order.averaged_w4 < 0.0 ? CrystalClass::fcc : CrystalClass::hcp;
}

} // namespace

std::string_view name_of(CrystalClass crystal) {
  constexpr std::array<std::string_view, n_crystal_classes> names = {"disordered", "fcc", "hcp", "bcc", "unknown"};
  return names[static_cast<std::size_t>(crystal)];
}

std::vector<BondOrder> bond_order(const NeighbourLists& neighbours, const BondOrderOptions& options) {
  check(neighbours, options);
  const auto q4 = local_harmonics<4>(neighbours);
  const auto q6 = local_harmonics<6>(neighbours);
  std::vector<BondOrder> orders(neighbours.size());
  for (std::size_t grain = 0; grain < neighbours.size(); ++grain) {
    BondOrder& order = orders[grain];
    const Harmonics<4> mean4 = averaged<4>(q4, static_cast<int>(grain), neighbours);
    const Harmonics<6> mean6 = averaged<6>(q6, static_cast<int>(grain), neighbours);
    order.q4 = second_invariant<4>(q4[grain]);
    order.q6 = second_invariant<6>(q6[grain]);
    order.averaged_q4 = second_invariant<4>(mean4);
    order.averaged_q6 = second_invariant<6>(mean6);
    order.averaged_w4 = third_invariant<4>(mean4);
    order.averaged_w6 = third_invariant<6>(mean6);
    order.n_neighbours = static_cast<int>(neighbours[grain].size());
    bool among_own_copies = false;
    for (const Neighbour& neighbour : neighbours[grain]) {
      const bool own = neighbour.grain == static_cast<int>(grain);
      const bool solid = !own && correlation(q6[grain], q6[neighbour.grain]) > options.solid_bond_cosine;
      order.solid.push_back(solid);
      order.n_solid_bonds += solid;
      among_own_copies = among_own_copies || own;
    }
    order.crystal = classify(order, among_own_copies, options);
  }
  return orders;
}

std::array<int, n_crystal_classes> count_classes(const std::vector<BondOrder>& orders) {
  std::array<int, n_crystal_classes> counts{};
  for (const BondOrder& order : orders) {
    ++counts[static_cast<std::size_t>(order.crystal)];
  }
  return counts;
}

} // namespace boba::measure
