// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/lammps_dump_reader.h"

#include "bpm/grain/sound_template.h"
#include "bpm/io/id_table.h"
#include "bpm/io/usable_cell.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string>

namespace boba::lammps {

namespace {

bool all_there(const std::array<int, 3>& columns) {
  return std::all_of(columns.begin(), columns.end(), [](int c) { return c >= 0; });
}

} // namespace

void DumpReader::need_line(std::string_view what) {
  if (!in_.next() || !in_.has_line_end()) {
    in_.fail_cut_off(fmt::format("the file ends where {} should follow", what));
  }
  if (in_.fields().empty()) {
    in_.fail(fmt::format("an empty line where {} should be", what));
  }
}

std::optional<FrameHead> DumpReader::next_head() {
  FrameHead head;
  bool has_begun = false, has_step = false, has_count = false, has_box = false;
  while (in_.next_with_fields()) {
    const std::string_view line = in_.line();
    if (!in_.has_line_end() && (line.starts_with("ITEM:") || std::string_view("ITEM:").starts_with(line))) {
      in_.fail_cut_off("the file ends inside a frame's head");
    }
    has_begun = true;
    if (line.starts_with("ITEM: TIMESTEP")) {
      need_line("the time step");
      head.frame.timestep = in_.integer(0, "time step");
      has_step = true;
    } else if (line.starts_with("ITEM: TIME")) {
      need_line("the time");
      head.frame.time = in_.real(0, "time");
    } else if (line.starts_with("ITEM: UNITS")) {
      need_line("the name of the units");
    } else if (line.starts_with("ITEM: NUMBER OF ATOMS")) {
      need_line("the number of atoms");
      head.n_rows = in_.count("number of atoms", sizeof(Vector3) + sizeof(std::int64_t));
      has_count = true;
    } else if (line.starts_with("ITEM: BOX BOUNDS")) {
      head.frame.box = read_box();
      has_box = true;
    } else if (line.starts_with("ITEM: ATOMS")) {
      if (!has_step || !has_count || !has_box) {
        in_.fail(fmt::format("'ITEM: ATOMS' before '{}'", !has_step    ? "ITEM: TIMESTEP"
                                                          : !has_count ? "ITEM: NUMBER OF ATOMS"
                                                                       : "ITEM: BOX BOUNDS"));
      }
      head.columns = read_columns();
      return head;
    } else {
      in_.fail("a line that begins with 'ITEM:' of a text dump of atoms is needed here");
    }
  }
  if (has_begun) {
    in_.fail_cut_off("the file ends inside a frame's head");
  }
  return std::nullopt;
}

Box DumpReader::read_box() {
  const std::vector<std::string_view>& fields = in_.fields();
  // ITEM: BOX BOUNDS [xy xz yz] [pp pp pp]
  const bool is_tilted = fields.size() >= 6 && fields[3] == "xy" && fields[4] == "xz" && fields[5] == "yz";
  if (fields.size() > 3 && fields[3] == "abc") {
    in_.fail("a general triclinic cell (abc origin); only BOX BOUNDS with xy xz yz are read");
  }
  const std::size_t flags = is_tilted ? 6 : 3;
  const auto is_boundary = [](std::string_view word) {
    return word.size() == 2 && word.find_first_not_of("pfsm") == std::string_view::npos;
  };
  if ((fields.size() != flags && fields.size() != flags + 3) ||
      !std::all_of(fields.begin() + static_cast<std::ptrdiff_t>(flags), fields.end(), is_boundary)) {
    in_.fail("'ITEM: BOX BOUNDS' is followed by 'xy xz yz' for a tilted cell, then by three boundaries as 'pp pp pp'");
  }
  std::array<bool, 3> periodic = {true, true, true};
  for (std::size_t axis = 0; axis < 3 && flags + axis < fields.size(); ++axis) {
    periodic[axis] = fields[flags + axis].starts_with('p');
  }
  Vector3 low, high, tilts = Vector3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    need_line("the limits of the box");
    if (in_.fields().size() != (is_tilted ? 3u : 2u)) {
      in_.fail(fmt::format("{} numbers; a limit of {} has {}", in_.fields().size(),
                           is_tilted ? "a tilted cell (xy xz yz)" : "an upright cell", is_tilted ? 3 : 2));
    }
    low[axis] = in_.real(0, "lower limit");
    high[axis] = in_.real(1, "upper limit");
    tilts[axis] = is_tilted ? in_.real(2, "tilt") : 0.0;
  }
  // The file gives the limits of the smallest upright box around the tilted cell.
  const double xy = tilts[0], xz = tilts[1], yz = tilts[2];
  low -= Vector3(std::min({0.0, xy, xz, xy + xz}), std::min(0.0, yz), 0.0);
  high -= Vector3(std::max({0.0, xy, xz, xy + xz}), std::max(0.0, yz), 0.0);
  if (!is_usable_cell(high - low, tilts) || !is_usable_position(low) || !is_usable_position(high)) {
    in_.fail(fmt::format("the box has lengths {} {} {}; they must be positive and not too large", high[0] - low[0],
                         high[1] - low[1], high[2] - low[2]));
  }
  return Box(low, high - low, tilts, periodic);
}

Columns DumpReader::read_columns() const {
  Columns columns;
  columns.n = in_.fields().size() - 2;
  const auto find = [&](std::string_view name) {
    for (std::size_t c = 0; c < columns.n; ++c) {
      if (in_.fields()[c + 2] == name) {
        return static_cast<int>(c);
      }
    }
    return -1;
  };
  columns.id = find("id");
  columns.molecule = find("mol");
  columns.type = find("type");
  columns.image = {find("ix"), find("iy"), find("iz")};
  columns.v = {find("vx"), find("vy"), find("vz")};
  columns.f = {find("fx"), find("fy"), find("fz")};
  for (const auto& [name, right] : {std::pair{"mass", 1.0}, {"diameter", 1.0}, {"radius", 0.5}}) {
    if (const int column = find(name); column >= 0) {
      columns.fixed.push_back({column, name, right});
    }
  }
  using Kind = Columns::Kind;
  for (const auto& [kind, suffix] :
       {std::pair{Kind::unwrapped, "u"}, {Kind::plain, ""}, {Kind::scaled_unwrapped, "su"}, {Kind::scaled, "s"}}) {
    const std::string end = suffix;
    columns.x = {find("x" + end), find("y" + end), find("z" + end)};
    if (all_there(columns.x)) {
      columns.kind = kind;
      break;
    }
  }
  if (columns.id < 0) {
    in_.fail("no column 'id'");
  }
  if (!all_there(columns.x)) {
    in_.fail("no columns 'x y z', 'xu yu zu', 'xs ys zs' or 'xsu ysu zsu'");
  }
  return columns;
}

Vector3 DumpReader::vector_at(const std::array<int, 3>& columns, std::string_view name) const {
  Vector3 value;
  for (int axis = 0; axis < 3; ++axis) {
    value[axis] = in_.real(columns[axis], name);
  }
  return value;
}

void DumpReader::need_usable(const Vector3& x, std::string_view name) const {
  if (!is_usable_position(x)) {
    in_.fail(fmt::format("the {} is {:g} {:g} {:g}; allowed: {:g} to {:g}", name, x[0], x[1], x[2], -largest_coordinate,
                         largest_coordinate));
  }
}

/// Every node's mass is 1 and its diameter 1: other values in a file would be ignored in silence.
void DumpReader::check_units(const Columns& columns) const {
  for (const auto& [column, name, right] : columns.fixed) {
    const double value = in_.real(static_cast<std::size_t>(column), name);
    if (std::abs(value - right) > 1e-4) {
      in_.fail(fmt::format("{} is {}; it must be {}", name, value, right));
    }
  }
}

Vector3 DumpReader::position_at(const Columns& columns, const Box& box) const {
  using Kind = Columns::Kind;
  Vector3 x = vector_at(columns.x, "position");
  if (columns.kind == Kind::scaled || columns.kind == Kind::scaled_unwrapped) {
    x = box.to_position(x);
  }
  if ((columns.kind == Kind::plain || columns.kind == Kind::scaled) && all_there(columns.image)) {
    Vector3 images;
    for (int axis = 0; axis < 3; ++axis) {
      images[axis] = static_cast<double>(in_.integer(columns.image[axis], "image flag"));
    }
    x += box.h() * images;
  }
  need_usable(x, "position");
  return x;
}

void DumpReader::read_row(const Columns& columns, LammpsFrame& frame) const {
  if (in_.fields().size() != columns.n) {
    in_.fail(fmt::format("{} columns; 'ITEM: ATOMS' names {}", in_.fields().size(), columns.n));
  }
  check_units(columns);
  frame.id.push_back(in_.integer(columns.id, "atom id", 1));
  frame.position.push_back(position_at(columns, frame.box));
  if (columns.molecule >= 0) {
    frame.molecule.push_back(in_.integer(columns.molecule, "molecule", 0));
  }
  if (columns.type >= 0) {
    const std::int64_t type = in_.integer(columns.type, "type", 1);
    if (type > std::numeric_limits<int>::max()) {
      in_.fail(fmt::format("type is {}; it must be {} or less", type, std::numeric_limits<int>::max()));
    }
    frame.type.push_back(static_cast<int>(type));
  }
  if (all_there(columns.v)) {
    frame.velocity.push_back(vector_at(columns.v, "velocity"));
    need_usable(frame.velocity.back(), "velocity");
  }
  if (all_there(columns.f)) {
    frame.force.push_back(vector_at(columns.f, "force"));
  }
}

/// At the end of the file, or of a line that has no end and whose last number may lack digits, the frame was cut off.
void DumpReader::fail_cut_off(const FrameHead& head, std::int64_t row, bool ends) const {
  const std::string what =
      fmt::format("the frame of step {} ends after {} of {} rows", head.frame.timestep, row, head.n_rows);
  if (!ends && in_.line().starts_with("ITEM:")) { // the next frame
    in_.fail(what);
  }
  in_.fail_cut_off(what);
}

LammpsFrame DumpReader::read_rows(FrameHead head) {
  LammpsFrame frame = head.frame;
  using Kind = Columns::Kind;
  const Columns& columns = head.columns;
  frame.is_unwrapped =
      columns.kind == Kind::unwrapped || columns.kind == Kind::scaled_unwrapped || all_there(columns.image);
  for (std::int64_t row = 0; row < head.n_rows; ++row) {
    if (const bool ends = !in_.next(); ends || in_.line().starts_with("ITEM:") || !in_.has_line_end()) {
      fail_cut_off(head, row, ends);
    }
    read_row(columns, frame);
  }
  if (const std::int64_t row = IdTable(frame.id).duplicate(); row != IdTable::none) {
    in_.fail(fmt::format("atom id {} stands twice in the frame of step {}", frame.id[row], frame.timestep));
  }
  return frame;
}

void DumpReader::skip_rows(const FrameHead& head) {
  for (std::int64_t row = 0; row < head.n_rows; ++row) {
    if (const bool ends = !in_.next(); ends || in_.line().starts_with("ITEM:") || !in_.has_line_end()) {
      fail_cut_off(head, row, ends);
    }
    if (in_.fields().size() != head.columns.n) {
      in_.fail(fmt::format("{} columns; 'ITEM: ATOMS' names {}", in_.fields().size(), head.columns.n));
    }
  }
}

} // namespace boba::lammps
