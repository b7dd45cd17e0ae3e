// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/node_pairs.h"

#include <algorithm>
#include <numeric>

namespace boba {

namespace {

using kernels::NodePair;

std::uint64_t key(const NodePair& pair) {
  return static_cast<std::uint64_t>(pair.i) << 32 | static_cast<std::uint32_t>(pair.j);
}

bool before(const NodePair& x, const NodePair& y) {
  return key(x) < key(y);
}

/// Nodes per pair up to which counting is the quicker way to sort.
constexpr std::size_t worth_counting = 50;

/// By counting the pairs of each i; the few with the same i are then put in order one by one.
void sort_by_counting(std::vector<NodePair>& pairs, std::int32_t n_first) {
  thread_local std::vector<std::int32_t> next; // place for the next pair of each i
  thread_local std::vector<NodePair> unsorted;
  unsorted.assign(pairs.begin(), pairs.end());
  next.assign(n_first, 0);
  for (const NodePair& pair : unsorted) {
    ++next[pair.i];
  }
  std::exclusive_scan(next.begin(), next.end(), next.begin(), 0);
  for (const NodePair& pair : unsorted) {
    pairs[next[pair.i]++] = pair;
  }
  for (std::size_t k = 1; k < pairs.size(); ++k) {
    const NodePair pair = pairs[k];
    std::size_t at = k;
    for (; at > 0 && before(pair, pairs[at - 1]); --at) {
      pairs[at] = pairs[at - 1];
    }
    pairs[at] = pair;
  }
}

} // namespace

void sort_pairs(std::vector<NodePair>& pairs, std::int32_t n_first) {
  if (worth_counting * pairs.size() > static_cast<std::size_t>(n_first)) {
    sort_by_counting(pairs, n_first);
  } else {
    std::sort(pairs.begin(), pairs.end(), before);
  }
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

void insert_pairs(std::vector<NodePair>& sorted, std::vector<NodePair>& added) {
  std::sort(added.begin(), added.end(), before);
  added.erase(std::unique(added.begin(), added.end()), added.end());
  std::erase_if(added,
                [&](const NodePair& pair) { return std::binary_search(sorted.begin(), sorted.end(), pair, before); });
  // From the back: each of what is there moves once, and no memory is asked for but the list's own.
  auto old = static_cast<std::ptrdiff_t>(sorted.size()) - 1;
  sorted.resize(sorted.size() + added.size());
  auto to = static_cast<std::ptrdiff_t>(sorted.size()) - 1;
  for (auto next = static_cast<std::ptrdiff_t>(added.size()) - 1; next >= 0; --to) {
    if (old >= 0 && before(added[next], sorted[old])) {
      sorted[to] = sorted[old--];
    } else {
      sorted[to] = added[next--];
    }
  }
}

} // namespace boba
