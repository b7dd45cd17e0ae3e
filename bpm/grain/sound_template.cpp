// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/sound_template.h"

#include <fmt/format.h>
#include <utility>

namespace boba {

namespace {

std::optional<std::string> unsound_bond(const GrainTemplate& grain) {
  const Bond* before = nullptr;
  for (const Bond& bond : grain.bonds) {
    if (bond.i < 0 || bond.i >= bond.j || bond.j >= grain.n_nodes()) {
      return fmt::format("a bond joins nodes {} and {}; there are {} nodes, and the first must be the smaller one",
                         bond.i, bond.j, grain.n_nodes());
    }
    if (!(bond.r0 >= shortest_rest_length && bond.r0 <= longest_rest_length)) {
      return fmt::format("the bond of nodes {} and {} has the rest length {:g} d; allowed: {:g} to {:g}", bond.i,
                         bond.j, bond.r0, shortest_rest_length, longest_rest_length);
    }
    if (before != nullptr && std::pair(before->i, before->j) >= std::pair(bond.i, bond.j)) {
      return fmt::format("the bond of nodes {} and {} is out of order or there twice", bond.i, bond.j);
    }
    before = &bond;
  }
  return std::nullopt;
}

} // namespace

std::optional<std::string> unsound_part(const GrainTemplate& grain) {
  if (grain.position.empty()) {
    return "it has no nodes";
  }
  for (int node = 0; node < grain.n_nodes(); ++node) {
    const Eigen::Vector3d& x = grain.position[node];
    if (!is_usable_position(x)) {
      return fmt::format("node {} lies at {:g} {:g} {:g} d; allowed: {:g} to {:g}", node, x[0], x[1], x[2],
                         -largest_coordinate, largest_coordinate);
    }
  }
  if (grain.period && !((grain.period->array() > 0.0).all() && is_usable_position(*grain.period))) {
    return fmt::format("its period is {:g} {:g} {:g} d; it must be positive, and {:g} at most", (*grain.period)[0],
                       (*grain.period)[1], (*grain.period)[2], largest_coordinate);
  }
  if (!(grain.reference_volume > 0.0 && grain.reference_volume <= 1e27)) {
    return fmt::format("it stands for a volume of {:g} d^3; it must be positive", grain.reference_volume);
  }
  return unsound_bond(grain);
}

} // namespace boba
