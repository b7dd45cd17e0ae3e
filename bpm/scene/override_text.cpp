// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/override_text.h"

#include "bpm/io/input_error.h"
#include "bpm/io/printable.h"
#include "bpm/toml/toml_node.h"

#include <algorithm>
#include <fmt/format.h>

namespace boba {

namespace {

bool has_control(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7F; });
}

bool is_toml_value(const std::string& value) {
  try {
    parse_toml("value = " + value + "\n", "");
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// As a basic string of TOML.
std::string quoted_text(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += fmt::format("\\{}", c);
    } else if (has_control({c})) {
      result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    } else {
      result += c;
    }
  }
  return result + "\"";
}

} // namespace

std::string one_line_override(const std::string& assignment) {
  if (!has_control(assignment)) {
    return assignment;
  }
  const std::size_t equals = std::min(assignment.find('='), assignment.size());
  const std::string place = assignment.substr(0, equals);
  std::string value = equals < assignment.size() ? assignment.substr(equals + 1) : "";
  if (!has_control(place)) {
    if (!is_toml_value(value)) {
      return place + "=" + quoted_text(value);
    }
    std::replace_if(
        value.begin(), value.end(), [](unsigned char c) { return c < ' '; }, ' ');
    const bool has_long_text = value.find(R"(""")") != std::string::npos || value.find("'''") != std::string::npos;
    if (!has_long_text && !has_control(value) && is_toml_value(value)) {
      return place + "=" + value;
    }
  }
  throw InputError(fmt::format("--set {}: holds a line break or another control character where one cannot be kept; "
                               "write it on one line",
                               printable(assignment)));
}

} // namespace boba
