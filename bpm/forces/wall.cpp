// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/wall.h"

#include "bpm/laws/wall.h"

#include <algorithm>

namespace boba {

double add_wall_forces(const Wall& wall, const PlainContact& contact, const LaneLayout& layout, int grain,
                       const LaneState& state, const LaneForce& f, bool with_sums, kernels::ContactSums& sums) {
  const double reach = 0.5 * contact.range();
  double total = 0.0;
  for (int node = 0; node < layout.n_nodes(grain); ++node) {
    const Vector3 x = state.position(grain, node);
    const double z = wall.normal.dot(x - wall.point);
    if (z >= reach) {
      continue;
    }
    const Vector3 v = state.velocity(grain, node);
    const double force = wall_force(contact, z, wall.normal.dot(v - wall.velocity));
    f(node, force * wall.normal);
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
      sums.potential += wall_energy(contact, z);
    }
  }
  return total;
}

} // namespace boba
