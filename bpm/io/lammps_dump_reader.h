// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/io/lammps_dump.h"
#include "bpm/io/line_reader.h"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace boba::lammps {

/// Where in a row the quantities stand; -1 where there is no such column.
struct Columns {
  enum class Kind { plain, unwrapped, scaled, scaled_unwrapped };
  int id = -1, molecule = -1, type = -1;
  Kind kind = Kind::plain;
  std::array<int, 3> x = {-1, -1, -1}, image = {-1, -1, -1}, v = {-1, -1, -1}, f = {-1, -1, -1};
  struct Fixed {
    int column;
    std::string_view name;
    double right;
  };
  std::vector<Fixed> fixed; ///< columns that may hold one value only
  std::size_t n = 0;
};

/// Everything of a frame but its rows.
struct FrameHead {
  LammpsFrame frame;
  std::int64_t n_rows = 0;
  Columns columns;
};

/// Reads a dump frame by frame: the head of each, then its rows or past them.
class DumpReader {
public:
  explicit DumpReader(const std::filesystem::path& path) : in_(path) {}
  /// Moves behind the next line `ITEM: ATOMS`; nothing at the end of the file.
  std::optional<FrameHead> next_head();
  LammpsFrame read_rows(FrameHead head);
  void skip_rows(const FrameHead& head);
  const LineReader& lines() const { return in_; }

private:
  void need_line(std::string_view what);
  Box read_box();
  Columns read_columns() const;
  void read_row(const Columns& columns, LammpsFrame& frame) const;
  Vector3 position_at(const Columns& columns, const Box& box) const;
  Vector3 vector_at(const std::array<int, 3>& columns, std::string_view name) const;
  void need_usable(const Vector3& x, std::string_view name) const;
  void check_units(const Columns& columns) const;
  [[noreturn]] void fail_cut_off(const FrameHead& head, std::int64_t row, bool ends) const;

  LineReader in_;
};

} // namespace boba::lammps
