// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/wall_forces.h"

#include <cstdint>
#include <numeric>

namespace boba {

void WallForces::begin() {
  forces_.assign(walls_.size(), std::vector<double>(layout_.n_grains(), 0.0));
}

template <class Real>
void WallForces::add(const PlainContact& law, const Block& block, const LaneState& state, Real* f, bool with_sums,
                     ForceSums& sums) {
  for (std::size_t wall = 0; wall < walls_.size(); ++wall) {
    for (int lane = 0; lane < block.n_lanes; ++lane) {
      const int grain = block.grain[lane];
      if (grain < 0) {
        continue;
      }
      const auto add_force = [&](int node, const Vector3& force) {
        for (int c = 0; c < 3; ++c) {
          f[(3 * static_cast<std::int64_t>(node) + c) * block.n_lanes + lane] += static_cast<Real>(force[c]);
        }
      };
      forces_[wall][grain] =
          add_wall_forces(walls_[wall], law, layout_, grain, state, add_force, with_sums, sums.contacts[grain]);
    }
  }
}

void WallForces::end(const Distribution& distribution) {
  for (std::size_t wall = 0; wall < walls_.size(); ++wall) {
    distribution.ranks->share_rows(forces_[wall], 1, distribution.ownership);
    walls_.set_force(wall, std::accumulate(forces_[wall].begin(), forces_[wall].end(), 0.0));
  }
}

template void WallForces::add(const PlainContact&, const Block&, const LaneState&, double*, bool, ForceSums&);
template void WallForces::add(const PlainContact&, const Block&, const LaneState&, float*, bool, ForceSums&);

} // namespace boba
