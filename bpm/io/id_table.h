// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace boba {

/// Finds the row of a file that has a given id. Ids may be any positive numbers in any order.
class IdTable {
public:
  static constexpr std::int64_t none = -1;

  /// Keeps the first of equal ids; duplicate() then tells the row of the second one.
  explicit IdTable(std::span<const std::int64_t> ids);

  /// Row of the id, or `none`.
  std::int64_t row(std::int64_t id) const;
  /// First row whose id stood in an earlier row already, or `none`.
  std::int64_t duplicate() const { return duplicate_; }

private:
  std::vector<std::int64_t> dense_; ///< by id, when the ids fill their range well enough
  std::unordered_map<std::int64_t, std::int64_t> sparse_;
  std::int64_t duplicate_ = none;
};

} // namespace boba
