// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <string>

namespace boba {

/// A positive, finite number of seconds; says so in one short sentence otherwise.
inline CLI::Validator positive_seconds() {
  const auto check = [](const std::string& text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_good =
        error == std::errc() && end == text.data() + text.size() && std::isfinite(value) && value > 0.0;
    return is_good ? std::string() : fmt::format("{}: must be a positive number of seconds, as 3600", text);
  };
  return {check, "SECONDS"};
}

} // namespace boba
