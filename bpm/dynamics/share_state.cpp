// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/share_state.h"

#include <algorithm>
#include <sstream>
#include <variant>

namespace boba {

namespace {

void share_value(SavedValue& value, const Ranks& ranks) {
  std::size_t type = value.values.index();
  ranks.broadcast(type);
  if (!ranks.is_root()) {
    value.values = type == 0   ? decltype(value.values)(SavedValue::Text())
                   : type == 1 ? decltype(value.values)(SavedValue::Reals())
                               : decltype(value.values)(SavedValue::Integers());
  }
  ranks.broadcast(value.shape);
  std::visit([&](auto& values) { ranks.broadcast(values); }, value.values);
}

} // namespace

void share_but_nodes(SavedState& state, const Ranks& ranks) {
  std::string names;
  for (const auto& [name, value] : state) {
    names += std::ranges::find(node_fields, name) != node_fields.end() ? "" : name + "\n";
  }
  ranks.broadcast(names);
  std::istringstream lines(names);
  for (std::string name; std::getline(lines, name);) {
    share_value(state[name], ranks);
  }
}

} // namespace boba
