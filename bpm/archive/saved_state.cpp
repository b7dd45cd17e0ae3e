// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/archive/saved_state.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace boba {

namespace {

constexpr std::int64_t most_values = std::int64_t{1} << 60; // no memory holds more

} // namespace

bool SavedValue::is_whole() const {
  std::int64_t n = 1;
  for (const std::int64_t extent : shape) {
    if (extent < 0 || (extent > 0 && n > most_values / extent)) {
      return false;
    }
    n *= extent;
  }
  if (std::holds_alternative<Text>(values)) {
    return shape.empty();
  }
  const auto* reals = std::get_if<Reals>(&values);
  return n == static_cast<std::int64_t>(reals != nullptr ? reals->size() : std::get<Integers>(values).size());
}

std::string description(const SavedValue& value) {
  if (std::holds_alternative<SavedValue::Text>(value.values)) {
    return "a text";
  }
  const std::string kind = std::holds_alternative<SavedValue::Reals>(value.values) ? "real number" : "integer";
  if (value.shape.empty()) {
    return (kind == "integer" ? "an " : "a ") + kind;
  }
  return fmt::format("{} {}s", fmt::join(value.shape, " x "), kind);
}

} // namespace boba
