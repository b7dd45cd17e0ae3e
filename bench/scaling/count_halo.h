// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stepper.h"

namespace boba::bench {

/// What an exchange of contact nodes would be on so many ranks.
struct HaloCount {
  int n_ranks = 1;
  double imbalance = 1.0;                    ///< largest work over the mean, lanes counted
  double mean_messages = 0.0;                ///< received by a rank
  double mean_nodes = 0.0, most_nodes = 0.0; ///< received by a rank
  double mean_ghosts = 0.0;                  ///< grains of others that a rank knows
};

/// Places a packing on ranks as a run would, and counts from the contact list of a run on one rank.
HaloCount count_halo(const Stepper& stepper, int n_ranks);

} // namespace boba::bench
