// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/trajectory_packing.h"

#include "bpm/io/input_error.h"
#include "bpm/io/naming.h"
#include "bpm/io/trajectory.h"
#include "bpm/packing/sound_packing.h"

#include <algorithm>
#include <fmt/format.h>

namespace boba {

namespace {

/// The undeformed nodes of a grain's template where they are stored, else the grain as the first frame shows it.
std::vector<Vector3> arrangement_of(const Topology& topology, const Snapshot& first, int grain) {
  const auto nodes = first.nodes_of(topology, grain);
  const auto t = static_cast<std::size_t>(topology.template_index[grain]);
  if (t < topology.undeformed.size() && topology.undeformed[t].size() == nodes.size()) {
    return topology.undeformed[t];
  }
  std::vector<Vector3> arrangement(nodes.begin(), nodes.end());
  for (Vector3& x : arrangement) {
    x -= first.grain_centre[grain];
  }
  return arrangement;
}

struct Networks {
  std::vector<std::shared_ptr<const GrainTemplate>> templates;
  std::vector<int> number; ///< in `templates`, by the stored number; a template that no grain is of has none (-1)
};

/// Undeformed networks: bonds of the first grain of each template.
Networks networks_of(const Topology& topology, const Snapshot& first, const std::filesystem::path& file) {
  const auto& index = topology.template_index; // not beyond the number of grains, or of undeformed templates
  const int n_templates = 1 + *std::max_element(index.begin(), index.end());
  std::vector<GrainTemplate> networks(n_templates);
  std::vector<int> model(n_templates, -1);
  for (int g = topology.n_grains() - 1; g >= 0; --g) {
    model[topology.template_index[g]] = g;
  }
  const std::vector<int> grain_of = topology.grain_of_node();
  for (const Topology::Pair& bond : topology.bonds) {
    const int g = grain_of[bond.i];
    const int t = topology.template_index[g];
    if (model[t] == g) {
      const auto i = static_cast<int>(bond.i - topology.first_node[g]),
                 j = static_cast<int>(bond.j - topology.first_node[g]);
      networks[t].bonds.push_back({std::min(i, j), std::max(i, j), bond.r0});
      const Vector3 d = first.position[bond.i] - first.position[bond.j];
      if ((d - first.box.minimum_image(d)).norm() > 1e-6 * bond.r0) {
        throw InputError(
            fmt::format("{}: nodes {} and {} are bonded across the boundary of the cell; a periodic specimen "
                        "cannot be taken from a trajectory",
                        file.string(), topology.id[bond.i], topology.id[bond.j]));
      }
    }
  }
  Networks result{{}, std::vector<int>(n_templates, -1)};
  for (int t = 0; t < n_templates; ++t) {
    if (model[t] < 0) {
      continue;
    }
    networks[t].position = arrangement_of(topology, first, model[t]);
    std::sort(networks[t].bonds.begin(), networks[t].bonds.end(),
              [](const Bond& a, const Bond& b) { return std::pair(a.i, a.j) < std::pair(b.i, b.j); });
    networks[t].reference_volume = nominal_volume(networks[t].n_nodes());
    result.number[t] = static_cast<int>(result.templates.size());
    result.templates.push_back(std::make_shared<const GrainTemplate>(std::move(networks[t])));
  }
  return result;
}

} // namespace

Packing read_trajectory_packing(const std::filesystem::path& file, int frame) {
  const TrajectoryReader reader(file);
  const Topology& topology = reader.topology();
  Snapshot state = reader.snapshot(frame);
  if (std::ranges::any_of(state.damage, [](double share) { return share > 0.0; })) {
    throw InputError(fmt::format("{}: step {} has broken bonds, and a trajectory does not say which: a run that is to "
                                 "continue from there needs its checkpoint",
                                 file.string(), state.step));
  }
  if (reader.bonds_yield() && frame != 0) {
    throw InputError(
        fmt::format("{}: the bonds of its grains yield, and a trajectory does not say how far they have at "
                    "step {}: a run that is to continue from there needs its checkpoint",
                    file.string(), state.step));
  }
  Packing packing;
  packing.box = state.box;
  Networks networks = networks_of(topology, reader.snapshot(0), file);
  packing.templates = std::move(networks.templates);
  for (int g = 0; g < topology.n_grains(); ++g) {
    packing.grains.push_back(
        {networks.number[topology.template_index[g]], topology.species[g], topology.alpha[g], topology.molecule[g]});
  }
  packing.id = topology.id;
  packing.position = std::move(state.position);
  packing.velocity = std::move(state.velocity);
  packing.strain = state.strain;
  for (std::size_t i = 0; i < packing.velocity.size(); ++i) { // a stage adds the profile of its own shear
    packing.velocity[i][0] -= state.streaming_rate * (packing.position[i][1] - packing.box.origin()[1]);
  }
  packing.velocity.resize(packing.position.size(), Vector3::Zero());
  naming(file, [&] { check_sound(packing); });
  return packing;
}

} // namespace boba
