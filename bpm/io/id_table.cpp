// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/id_table.h"

#include <algorithm>

namespace boba {

IdTable::IdTable(std::span<const std::int64_t> ids) {
  const auto n = static_cast<std::int64_t>(ids.size());
  const bool empty = ids.empty();
  const std::int64_t smallest = empty ? 0 : *std::min_element(ids.begin(), ids.end());
  const std::int64_t largest = empty ? 0 : *std::max_element(ids.begin(), ids.end());
  const bool is_dense = smallest >= 0 && largest < 8 * n + 1024;
  if (is_dense) {
    dense_.assign(largest + 1, none);
  } else {
    sparse_.reserve(ids.size());
  }
  for (std::int64_t row = 0; row < n; ++row) {
    bool is_new = false;
    if (is_dense) {
      is_new = dense_[ids[row]] == none;
      if (is_new) {
        dense_[ids[row]] = row;
      }
    } else {
      is_new = sparse_.emplace(ids[row], row).second;
    }
    if (!is_new && duplicate_ == none) {
      duplicate_ = row;
    }
  }
}

std::int64_t IdTable::row(std::int64_t id) const {
  if (!dense_.empty()) {
    return id >= 0 && id < static_cast<std::int64_t>(dense_.size()) ? dense_[id] : none;
  }
  const auto found = sparse_.find(id);
  return found == sparse_.end() ? none : found->second;
}

} // namespace boba
