// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/parallel/ranks.h"

namespace boba {

/// The ranks and which grains each of them owns. With one rank the ownership is not looked at.
struct Distribution {
  const Ranks* ranks = &Ranks::alone();
  Ownership ownership;

  static const Distribution& alone() {
    static const Distribution one;
    return one;
  }
  bool is_distributed() const { return ranks->is_distributed(); }
  bool mine(int grain) const { return !is_distributed() || ownership.owner(grain) == ranks->rank(); }
};

} // namespace boba
