// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"

#include <cstdint>
#include <vector>

namespace boba {

/// Sorts pairs by i, then j, and leaves one of those that stand twice. All i lie in [0, n_first).
void sort_pairs(std::vector<kernels::NodePair>& pairs, std::int32_t n_first);

/// Brings pairs in any order into a list that is sorted, each once; `added` keeps those that the list did not have.
void insert_pairs(std::vector<kernels::NodePair>& sorted, std::vector<kernels::NodePair>& added);

} // namespace boba
