// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/measure/measure_tables.h"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace boba {

/// averages.json: time averages of what was measured, by the name of the quantity. Source: docs/formats-measure.md.
///
/// Each call of `boba measure` replaces the quantities that it measured and keeps the others.
class AveragesFile {
public:
  /// Reads what is there. \throws InputError when that was not written by this class: it is left alone
  explicit AveragesFile(std::filesystem::path path);
  ~AveragesFile();
  AveragesFile(AveragesFile&&) noexcept;
  AveragesFile& operator=(AveragesFile&&) noexcept;

  /// Averages over the frames with strain inside the window (all without one), and writes the file in one go; nothing
  /// when it would be empty. Returns a line a quantity for the terminal. \throws std::runtime_error when it cannot be
  /// written.
  std::string write(const std::map<std::string, MeasureTables::Series>& series,
                    const std::optional<std::array<double, 2>>& window);

private:
  struct Impl;
  std::filesystem::path path_;
  std::unique_ptr<Impl> impl_;
};

} // namespace boba
