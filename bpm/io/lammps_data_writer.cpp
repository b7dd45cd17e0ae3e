// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/lammps_data.h"

#include <algorithm>

namespace boba {

void write_lammps_data(const std::filesystem::path& path, const Topology& topology, const Snapshot& snapshot,
                       FileMode mode) {
  OutputFile out(path, mode);
  const Box& box = snapshot.box;
  const Vector3 low = box.origin(), high = box.origin() + box.lengths();
  const int n_types =
      topology.species.empty() ? 1 : 1 + *std::max_element(topology.species.begin(), topology.species.end());
  out.print("LAMMPS data file written by Boba, timestep = {}, units = lj\n\n", snapshot.step);
  out.print("{} atoms\n{} atom types\n{} bonds\n1 bond types\n\n", topology.n_nodes(), n_types, topology.bonds.size());
  for (int axis = 0; axis < 3; ++axis) {
    out.print("{0:.17g} {1:.17g} {2}lo {2}hi\n", low[axis], high[axis], "xyz"[axis]);
  }
  out.print("{:.17g} {:.17g} {:.17g} xy xz yz\n\nMasses\n\n", box.xy(), box.xz(), box.yz());
  for (int type = 1; type <= n_types; ++type) {
    out.print("{} 1\n", type);
  }
  out.print("\nAtoms # bond\n\n");
  for (int grain = 0; grain < topology.n_grains(); ++grain) {
    for (std::int64_t node = topology.first_node[grain]; node < topology.first_node[grain + 1]; ++node) {
      const Eigen::Vector3i n = box.image_of(snapshot.position[node]);
      const Vector3 x = snapshot.position[node] - box.h() * n.cast<double>();
      out.print("{} {} {} {:.17g} {:.17g} {:.17g} {} {} {}\n", topology.id[node], topology.molecule[grain],
                topology.species[grain] + 1, x[0], x[1], x[2], n[0], n[1], n[2]);
    }
  }
  if (!snapshot.velocity.empty()) {
    out.print("\nVelocities\n\n");
    for (std::int64_t node = 0; node < topology.n_nodes(); ++node) {
      const Vector3& v = snapshot.velocity[node];
      out.print("{} {:.17g} {:.17g} {:.17g}\n", topology.id[node], v[0], v[1], v[2]);
    }
  }
  if (!topology.bonds.empty()) {
    out.print("\nBonds\n\n");
    for (std::size_t b = 0; b < topology.bonds.size(); ++b) {
      out.print("{} 1 {} {}\n", b + 1, topology.id[topology.bonds[b].i], topology.id[topology.bonds[b].j]);
    }
  }
  out.close();
}

} // namespace boba
