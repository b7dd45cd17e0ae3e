// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/checkpoint_names.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <optional>
#include <string_view>

namespace boba {

namespace {

/// No run writes as many; a file of a larger number is not one of ours, and numbers go on without running over.
constexpr std::uint64_t largest_number = 999'999'999'999;

constexpr std::string_view stem = "checkpoint-", ending = ".boba";

std::optional<std::uint64_t> number_in(const std::string& name) {
  if (!name.starts_with(stem) || !name.ends_with(ending)) {
    return std::nullopt;
  }
  std::uint64_t number = 0;
  const char* end = name.data() + name.size() - ending.size();
  const auto [stop, error] = std::from_chars(name.data() + stem.size(), end, number);
  const bool is_number = error == std::errc() && stop == end && number <= largest_number;
  return is_number ? std::optional(number) : std::nullopt;
}

} // namespace

std::string checkpoint_name(std::uint64_t number) {
  return fmt::format("{}{:06}{}", stem, number, ending);
}

std::vector<NumberedCheckpoint> checkpoints_in(const std::filesystem::path& directory) {
  std::vector<NumberedCheckpoint> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (const auto number = number_in(entry.path().filename().string())) {
      files.push_back({*number, entry.path()});
    }
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.number > b.number; });
  return files;
}

} // namespace boba
