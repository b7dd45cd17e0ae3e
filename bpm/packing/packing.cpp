// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/packing.h"

#include <algorithm>

namespace boba {

std::vector<std::int64_t> Packing::first_nodes() const {
  std::vector<std::int64_t> first(grains.size() + 1, 0);
  for (int g = 0; g < n_grains(); ++g) {
    first[g + 1] = first[g] + template_of(g).n_nodes();
  }
  return first;
}

std::vector<int> Packing::nodes_of_grains() const {
  std::vector<int> n_nodes;
  n_nodes.reserve(static_cast<std::size_t>(n_grains()));
  for (int g = 0; g < n_grains(); ++g) {
    n_nodes.push_back(template_of(g).n_nodes());
  }
  return n_nodes;
}

Topology Packing::topology(bool with_bonds) const {
  Topology topology;
  topology.first_node = first_nodes();
  topology.id = id;
  for (const Grain& grain : grains) {
    topology.molecule.push_back(grain.molecule);
    topology.species.push_back(grain.species);
    topology.alpha.push_back(grain.alpha);
    topology.template_index.push_back(grain.template_index);
  }
  for (const auto& grain_template : templates) {
    topology.undeformed.push_back(is_at_rest(*grain_template) ? grain_template->position : std::vector<Vector3>{});
  }
  if (with_bonds) {
    for (int g = 0; g < n_grains(); ++g) {
      const std::int64_t first = topology.first_node[g];
      for (const Bond& bond : template_of(g).bonds) {
        topology.bonds.push_back({first + bond.i, first + bond.j, bond.r0});
      }
    }
  }
  return topology;
}

bool bonds_break(const Packing& packing) {
  return std::ranges::any_of(packing.grains, [](const Grain& grain) { return grain.breaking.is_possible(); });
}

bool bonds_yield(const Packing& packing) {
  return std::ranges::any_of(packing.grains, [](const Grain& grain) { return grain.yielding.is_possible(); });
}

Packing make_packing(const Box& box, std::vector<std::shared_ptr<const GrainTemplate>> templates,
                     const std::vector<Placement>& placements) {
  Packing packing;
  packing.box = box;
  packing.templates = std::move(templates);
  for (const Placement& placement : placements) {
    packing.grains.push_back(placement.grain);
    packing.grains.back().molecule = packing.n_grains();
    for (const Vector3& x : packing.templates[placement.grain.template_index]->position) {
      packing.position.push_back(placement.centre + placement.rotation * x);
      packing.id.push_back(static_cast<std::int64_t>(packing.position.size()));
    }
  }
  packing.velocity.assign(packing.position.size(), Vector3::Zero());
  return packing;
}

} // namespace boba
