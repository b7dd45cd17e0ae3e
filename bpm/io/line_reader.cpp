// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/line_reader.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

namespace boba {

namespace {

constexpr std::size_t least_chunk = 1 << 11, largest_chunk = 1 << 16;
constexpr std::size_t longest_line = 1 << 20;

/// A field for a message: shortened, and without bytes that would upset a terminal.
std::string shown(std::string_view field) {
  std::string text;
  for (const char c : field.substr(0, 40)) {
    text += (c >= ' ' && c <= '~') ? c : '?';
  }
  return field.size() > 40 ? text + "..." : text;
}

std::string_view without_plus(std::string_view field) {
  return field.size() > 1 && field[0] == '+' && field[1] != '-' ? field.substr(1) : field;
}

} // namespace

void LineReader::CloseGz::operator()(gzFile_s* file) const {
  gzclose(file);
}

LineReader::LineReader(const std::filesystem::path& path) : path_(path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    fail_file("is a folder; a file is needed");
  }
  errno = 0;
  file_.reset(gzopen(path.c_str(), "rb"));
  if (!file_) {
    fail_file(fmt::format("cannot be opened: {}", std::strerror(errno)));
  }
  // A small file asks for little memory, however many of them are read.
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  chunk_size_ = ignored ? largest_chunk : std::clamp<std::size_t>(size + 1, least_chunk, largest_chunk);
  gzbuffer(file_.get(), static_cast<unsigned>(chunk_size_));
}

bool LineReader::fill() {
  if (at_end_) {
    return false;
  }
  buffer_.erase(0, begin_);
  begin_ = 0;
  const std::size_t kept = buffer_.size();
  buffer_.resize(kept + chunk_size_);
  const int got = gzread(file_.get(), buffer_.data() + kept, static_cast<unsigned>(chunk_size_));
  buffer_.resize(kept + static_cast<std::size_t>(got > 0 ? got : 0));
  int code = Z_OK;
  const char* message = gzerror(file_.get(), &code);
  if (code == Z_BUF_ERROR) { // what was read before the end is handed out first
    at_end_ = is_cut_off_ = true;
    return got > 0;
  }
  if (got < 0 || (code != Z_OK && code != Z_STREAM_END)) {
    fail(fmt::format("damaged or truncated compressed data ({})", code == Z_ERRNO ? std::strerror(errno) : message));
  }
  at_end_ = static_cast<std::size_t>(got) < chunk_size_;
  return got > 0;
}

bool LineReader::next() {
  std::size_t end = buffer_.find('\n', begin_);
  while (end == std::string::npos) {
    const std::size_t searched = buffer_.size() - begin_;
    if (searched > longest_line) {
      ++line_number_;
      fail("line of more than 1 MiB; this is not a text file");
    }
    if (!fill()) {
      break;
    }
    end = buffer_.find('\n', begin_ + searched);
  }
  if (end == std::string::npos) {
    if (is_cut_off_) {
      fail_cut_off("the compressed data end too early: the file was cut off");
    }
    if (begin_ == buffer_.size()) {
      return false;
    }
    end = buffer_.size();
  }
  line_.assign(buffer_, begin_, end - begin_);
  has_line_end_ = end < buffer_.size();
  bytes_read_ += line_.size() + (has_line_end_ ? 1 : 0);
  begin_ = std::min(end + 1, buffer_.size());
  if (!line_.empty() && line_.back() == '\r') {
    line_.pop_back();
  }
  ++line_number_;
  split();
  return true;
}

bool LineReader::next_with_fields() {
  while (next()) {
    if (!fields_.empty()) {
      return true;
    }
  }
  return false;
}

void LineReader::split() {
  constexpr std::string_view blanks = " \t\v\f\r";
  fields_.clear();
  const std::string_view text = std::string_view(line_).substr(0, line_.find('#'));
  std::size_t begin = text.find_first_not_of(blanks);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    fields_.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
}

double LineReader::real(std::size_t column, std::string_view name) const {
  const std::string_view field = without_plus(fields_.at(column));
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error == std::errc::result_out_of_range) {
    // Either too large, or so small that it is zero in double precision.
    value = std::strtod(std::string(field).c_str(), nullptr);
  } else if (error != std::errc()) {
    fail(fmt::format("{} is '{}'; a number is needed", name, shown(field)));
  }
  if (end != field.data() + field.size()) {
    fail(fmt::format("{} is '{}'; a number is needed", name, shown(field)));
  }
  if (!std::isfinite(value)) {
    fail(fmt::format("{} is '{}'; it must be finite", name, shown(field)));
  }
  return value;
}

std::int64_t LineReader::integer(std::size_t column, std::string_view name, std::int64_t smallest) const {
  const std::string_view field = without_plus(fields_.at(column));
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) {
    fail(fmt::format("{} is '{}'; a whole number is needed", name, shown(field)));
  }
  if (value < smallest) {
    fail(fmt::format("{} is {}; it must be {} or more", name, value, smallest));
  }
  return value;
}

std::int64_t LineReader::count(std::string_view name, std::size_t bytes_each) const {
  const std::int64_t value = integer(0, name, 0);
  const double memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  const double needed = static_cast<double>(value) * static_cast<double>(bytes_each);
  if (needed > memory) {
    fail(fmt::format("{} is {}, which needs {:.3g} GB; this machine has {:.3g} GB", name, value, needed / 1e9,
                     memory / 1e9));
  }
  return value;
}

void LineReader::fail(std::string_view message) const {
  throw InputError(fmt::format("{}:{}: {}", path_.string(), line_number_, message));
}

void LineReader::fail_cut_off(std::string_view message) const {
  throw CutOff(fmt::format("{}:{}: {}", path_.string(), line_number_, message));
}

void LineReader::fail_file(std::string_view message) const {
  throw InputError(fmt::format("{}: {}", path_.string(), message));
}

} // namespace boba
