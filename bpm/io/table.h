// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/output_file.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace boba {

/// Writes a CSV table, row by row: whole numbers as such, others with 17 significant digits at most so that they read
/// back exactly; a value that is not known is an empty field. Names carry their unit, e.g. `time_tau`.
///
/// The first column is the step; each row is handed to the operating system at once.
class TableWriter {
public:
  /// \throws std::runtime_error when the file exists (FileMode::create) or cannot be written;
  /// std::invalid_argument when there is no column or a name holds a comma, a quote or a line end.
  TableWriter(const std::filesystem::path& path, const std::vector<std::string>& columns,
              FileMode mode = FileMode::create);
  /// Goes on after the last row whose step is `last_step` or earlier; later rows and a torn one are removed. A missing
  /// file is begun again. \throws std::runtime_error when the file has other columns.
  static TableWriter go_on(const std::filesystem::path& path, const std::vector<std::string>& columns,
                           std::int64_t last_step);

  /// One row; as many values as there are columns behind the step. \throws std::invalid_argument for another number.
  void write(std::int64_t step, std::span<const std::optional<double>> values);
  void write(std::int64_t step, std::span<const double> values);
  void close() { file_.close(); }

private:
  TableWriter(OutputFile file, std::size_t n_columns);
  OutputFile file_;
  std::size_t n_columns_;
};

} // namespace boba
