// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/snapshot.h"

namespace boba {

std::vector<int> Topology::grain_of_node() const {
  std::vector<int> grain(n_nodes());
  for (int g = 0; g < n_grains(); ++g) {
    for (std::int64_t node = first_node[g]; node < first_node[g + 1]; ++node) {
      grain[node] = g;
    }
  }
  return grain;
}

} // namespace boba
