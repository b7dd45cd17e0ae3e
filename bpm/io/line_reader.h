// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/input_error.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;

namespace boba {

/// A file ends where more should follow: it was cut off, or is still being written.
class CutOff : public InputError {
public:
  using InputError::InputError;
};

/// Reads a text file, plain or gzipped, line by line and turns its fields into numbers.
///
/// Every failure is an InputError that names the file, the line and the offending value, so a caller only says what it
/// expects. Line ends may be LF or CR LF; `#` starts a comment, which fields() leaves out.
class LineReader {
public:
  /// \throws InputError when the file is missing or cannot be read.
  explicit LineReader(const std::filesystem::path& path);

  /// Moves to the next line; false at the end. \throws InputError on damaged gzip data or a line over 1 MiB.
  bool next();
  /// Moves to the next line that holds a field.
  bool next_with_fields();

  std::string_view line() const { return line_; }
  /// Blank-separated fields of the line, up to `#`.
  const std::vector<std::string_view>& fields() const { return fields_; }
  std::int64_t line_number() const { return line_number_; }
  /// Bytes of (uncompressed) text up to the end of the line.
  std::uint64_t bytes_read() const { return bytes_read_; }
  /// False on a last line that has no line end.
  bool has_line_end() const { return has_line_end_; }
  const std::filesystem::path& path() const { return path_; }

  /// The field as a finite number; `name` says in the message what it is.
  double real(std::size_t column, std::string_view name) const;
  /// The field as a whole number not below `smallest`.
  std::int64_t integer(std::size_t column, std::string_view name, std::int64_t smallest = INT64_MIN) const;
  /// A count at field 0 of things that take `bytes_each` in memory. \throws InputError when they cannot fit.
  std::int64_t count(std::string_view name, std::size_t bytes_each) const;

  [[noreturn]] void fail(std::string_view message) const;
  [[noreturn]] void fail_cut_off(std::string_view message) const; ///< \throws CutOff
  /// Fails without a line number, for what is missing from the whole file.
  [[noreturn]] void fail_file(std::string_view message) const;

private:
  struct CloseGz {
    void operator()(gzFile_s* file) const;
  };
  bool fill();
  void split();

  std::filesystem::path path_;
  std::unique_ptr<gzFile_s, CloseGz> file_;
  std::string buffer_;
  std::size_t begin_ = 0; ///< of what is not yet handed out in buffer_
  bool at_end_ = false;
  bool is_cut_off_ = false;    ///< compressed data end too early
  std::size_t chunk_size_ = 0; ///< bytes asked for at a time
  std::string line_;
  std::vector<std::string_view> fields_;
  std::int64_t line_number_ = 0;
  std::uint64_t bytes_read_ = 0;
  bool has_line_end_ = true;
};

} // namespace boba
