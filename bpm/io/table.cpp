// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/table.h"

#include <cctype>
#include <charconv>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>

namespace boba {

namespace {

std::string header_of(const std::vector<std::string>& columns) {
  if (columns.empty()) {
    throw std::invalid_argument("table: no columns; the first one is the step");
  }
  for (const std::string& column : columns) {
    if (column.empty() || column.find_first_of(",\"\r\n") != std::string::npos) {
      throw std::invalid_argument(
          fmt::format("table: column name '{}'; it needs a letter and no comma, quote or line end", column));
    }
  }
  return fmt::format("{}\n", fmt::join(columns, ","));
}

/// Bytes up to the end of the last whole row with a step up to `last_step`; `text` begins behind the header. Rows that
/// are no rows any more, but stand before one that is, are kept: somebody edited them.
std::size_t kept_length(const std::string& text, std::int64_t last_step) {
  std::size_t kept = 0, begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', begin)) {
    std::int64_t step = 0;
    const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, step);
    const bool is_row = error == std::errc() && (*stop == ',' || *stop == '\n');
    if (is_row && step > last_step) {
      break;
    }
    begin = end + 1;
    kept = is_row ? begin : kept;
  }
  return kept;
}

} // namespace

TableWriter::TableWriter(const std::filesystem::path& path, const std::vector<std::string>& columns, FileMode mode)
    : file_((header_of(columns), path), mode), n_columns_(columns.size()) {
  file_.write(header_of(columns));
}

TableWriter::TableWriter(OutputFile file, std::size_t n_columns) : file_(std::move(file)), n_columns_(n_columns) {}

TableWriter TableWriter::go_on(const std::filesystem::path& path, const std::vector<std::string>& columns,
                               std::int64_t last_step) {
  const std::string header = header_of(columns);
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (text.size() < header.size() && header.starts_with(text)) { // missing, empty, or killed within its first line
    return TableWriter(path, columns, FileMode::overwrite);
  }
  if (!text.starts_with(header)) {
    throw std::runtime_error(fmt::format("{}: begins with '{}'; a table to continue begins with '{}'", path.string(),
                                         text.substr(0, text.find('\n')), header.substr(0, header.size() - 1)));
  }
  cut_file(path, header.size() + kept_length(text.substr(header.size()), last_step));
  return TableWriter(OutputFile(path, FileMode::append), columns.size());
}

void TableWriter::write(std::int64_t step, std::span<const std::optional<double>> values) {
  if (values.size() + 1 != n_columns_) {
    throw std::invalid_argument(
        fmt::format("table: {} values behind the step; {} are needed", values.size(), n_columns_ - 1));
  }
  std::string row = std::to_string(step);
  for (const std::optional<double>& value : values) {
    row += value ? fmt::format(",{}", *value) : ","; // fmt gives the shortest text that reads back exactly
  }
  file_.write(row + "\n");
}

void TableWriter::write(std::int64_t step, std::span<const double> values) {
  const std::vector<std::optional<double>> optional_values(values.begin(), values.end());
  write(step, optional_values);
}

} // namespace boba
