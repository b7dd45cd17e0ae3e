// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace boba {

/// A saved state cannot be read: a field is missing, or it has another type or shape than the program expects.
class SavedStateError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// One field of a saved state: its values and how they are arranged.
struct SavedValue {
  using Text = std::string;
  using Reals = std::vector<double>;
  using Integers = std::vector<std::int64_t>;

  std::variant<Text, Reals, Integers> values;
  /// {} for a single value, {n} for a list, {n, 3} for n vectors, {3, 3} for a matrix. A text is a single value.
  std::vector<std::int64_t> shape;

  /// Are there as many values as the shape says?
  bool is_whole() const;
  bool operator==(const SavedValue&) const = default;
};

/// What must be stored for a run to continue bit for bit: fields by name. Names are nested by dots,
/// "simulation.stage.driver.gain".
using SavedState = std::map<std::string, SavedValue>;

/// "a text", "a real number", "3 integers", "1024 x 3 real numbers".
std::string description(const SavedValue& value);

} // namespace boba
