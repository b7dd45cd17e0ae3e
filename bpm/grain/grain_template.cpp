// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/grain_template.h"

namespace boba {

std::vector<double> reference_node_volumes(int n_nodes, const std::vector<Bond>& bonds) {
  std::vector<double> volume(n_nodes, 0.0);
  for (const Bond& bond : bonds) {
    const double cube = bond.r0 * bond.r0 * bond.r0;
    volume[bond.i] += cube;
    volume[bond.j] += cube;
  }
  return volume;
}

} // namespace boba
