// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/wall.h"

#include "bpm/laws/wall.h"

#include <algorithm>

namespace boba {

double add_wall_forces(const Wall& wall, const Material& material, const LaneLayout& layout, int grain,
                       const LaneState& state, double* f, bool with_sums, kernels::ContactSums& sums) {
  const std::int64_t first = layout.first(grain), stride = layout.stride(grain);
  const double reach = 0.5 * material.diameter;
  double total = 0.0;
  for (std::int64_t node = 0; node < layout.n_nodes(grain); ++node) {
    const std::int64_t at = first + 3 * node * stride;
    const Vector3 x(state.x[at], state.x[at + stride], state.x[at + 2 * stride]);
    const double z = wall.normal.dot(x - wall.point);
    if (z >= reach) {
      continue;
    }
    const Vector3 v(state.v[at], state.v[at + stride], state.v[at + 2 * stride]);
    const double force = wall_force(material.k, material.k3, material.gamma, material.diameter, z,
                                    wall.normal.dot(v - wall.velocity));
    for (int c = 0; c < 3; ++c) {
      f[at + c * stride] += force * wall.normal[c];
    }
    total += force;
    if (with_sums) {
      // The pair is node and wall; half of its virial r f with r = 2 z n is z n (x) f n.
      const Vector3 n = wall.normal;
      const double s = z * force;
      const double dyad[6] = {n[0] * n[0], n[1] * n[1], n[2] * n[2], n[0] * n[1], n[0] * n[2], n[1] * n[2]};
      for (int c = 0; c < 6; ++c) {
        sums.virial[c] += s * dyad[c];
      }
      const double r = std::max(2.0 * z, 0.0);
      sums.smallest_r2 = std::min(sums.smallest_r2, r * r);
      sums.potential += 0.5 * contact_energy(material.k, material.k3, material.diameter, 2.0 * z);
    }
  }
  return total;
}

} // namespace boba
