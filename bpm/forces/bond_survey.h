// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/network_data.h"
#include "bpm/laws/bond.h"
#include "bpm/packing/box.h"
#include "bpm/packing/lane_state.h"
#include "bpm/parallel/distribution.h"

#include <cstdint>
#include <vector>

namespace boba {

/// The broken bonds of a grain, sorted by nodes.
std::vector<kernels::NodePair> broken_bonds(const NetworkData& network, const LaneLayout& layout,
                                            const LaneState& state, int grain);

/// How far a bond is stretched, and whose it is.
struct Stretch {
  double ratio = 0.0; ///< r / r0
  int grain = 0, node = 0;
};

/// Passes over all bonds of a packing in plain scalars, for rare use.
/// Cost: about 20 operations per bond, each function.
class BondSurvey {
public:
  /// All of these must outlive this object.
  BondSurvey(const std::vector<const NetworkData*>& network_of_grain, const BondLaw& law, const LaneLayout& layout,
             const LaneState& state, const Distribution& distribution)
      : network_of_grain_(network_of_grain), law_(law), layout_(layout), state_(state), distribution_(distribution) {}

  /// Pairwise elastic energy of all bonds, k d^2. Collective.
  double energy(const Box& box) const;
  /// Per node of a grain of this rank: how many of its bonds are whole.
  std::vector<int> whole_bonds(int grain) const;
  /// Per node of a grain of this rank: the share of its bonds that are broken.
  std::vector<double> damage(int grain) const;
  /// Broken bonds of all grains. Collective.
  std::int64_t n_broken() const;
  /// Mean plastic strain p (YieldingBondLaw) of the bonds that may yield, the broken ones included. Collective.
  double plastic_strain() const;
  /// The whole bond with the largest r / r0, over the grains of this rank.
  Stretch largest_stretch(const Box& box) const;

private:
  const std::vector<const NetworkData*>& network_of_grain_;
  BondLaw law_;
  const LaneLayout& layout_;
  const LaneState& state_;
  const Distribution& distribution_;
};

} // namespace boba
