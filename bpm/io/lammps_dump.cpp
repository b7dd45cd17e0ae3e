// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/lammps_dump.h"

#include "bpm/io/id_table.h"
#include "bpm/io/line_reader.h"
#include "bpm/io/usable_cell.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <limits>
#include <string>

namespace boba {

namespace {

/// Where in a row the quantities stand; -1 where there is no such column.
struct Columns {
  enum class Kind { plain, unwrapped, scaled, scaled_unwrapped };
  int id = -1, molecule = -1, type = -1;
  Kind kind = Kind::plain;
  std::array<int, 3> x = {-1, -1, -1}, image = {-1, -1, -1}, v = {-1, -1, -1}, f = {-1, -1, -1};
  std::size_t n = 0;
};

bool all_there(const std::array<int, 3>& columns) {
  return std::all_of(columns.begin(), columns.end(), [](int c) { return c >= 0; });
}

/// Everything of a frame but its rows.
struct FrameHead {
  LammpsFrame frame;
  std::int64_t n_rows = 0;
  Columns columns;
};

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

  LineReader in_;
};

void DumpReader::need_line(std::string_view what) {
  if (!in_.next()) {
    in_.fail(fmt::format("the file ends where {} should follow", what));
  }
  if (in_.fields().empty()) {
    in_.fail(fmt::format("an empty line where {} should be", what));
  }
}

std::optional<FrameHead> DumpReader::next_head() {
  FrameHead head;
  bool has_step = false, has_count = false, has_box = false;
  while (in_.next_with_fields()) {
    const std::string_view line = in_.line();
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
  if (has_step || has_count || has_box) {
    in_.fail("the file ends inside a frame's head");
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
  std::array<bool, 3> periodic = {true, true, true};
  for (std::size_t axis = 0; axis < 3 && flags + axis < fields.size(); ++axis) {
    periodic[axis] = fields[flags + axis].starts_with('p');
  }
  Vector3 low, high, tilts = Vector3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    need_line("the limits of the box");
    if (in_.fields().size() < (is_tilted ? 3u : 2u)) {
      in_.fail(fmt::format("{} numbers; a limit of the box has {}", in_.fields().size(), is_tilted ? 3 : 2));
    }
    low[axis] = in_.real(0, "lower limit");
    high[axis] = in_.real(1, "upper limit");
    tilts[axis] = is_tilted ? in_.real(2, "tilt") : 0.0;
  }
  // The file gives the limits of the smallest upright box around the tilted cell.
  const double xy = tilts[0], xz = tilts[1], yz = tilts[2];
  low -= Vector3(std::min({0.0, xy, xz, xy + xz}), std::min(0.0, yz), 0.0);
  high -= Vector3(std::max({0.0, xy, xz, xy + xz}), std::max(0.0, yz), 0.0);
  if (!is_usable_cell(high - low, tilts)) {
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
  if (!x.allFinite()) {
    in_.fail("the position is beyond what numbers can hold");
  }
  return x;
}

void DumpReader::read_row(const Columns& columns, LammpsFrame& frame) const {
  if (in_.fields().size() < columns.n) {
    in_.fail(fmt::format("{} columns; 'ITEM: ATOMS' names {}", in_.fields().size(), columns.n));
  }
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
  }
  if (all_there(columns.f)) {
    frame.force.push_back(vector_at(columns.f, "force"));
  }
}

LammpsFrame DumpReader::read_rows(FrameHead head) {
  LammpsFrame frame = std::move(head.frame);
  using Kind = Columns::Kind;
  const Columns& columns = head.columns;
  frame.is_unwrapped =
      columns.kind == Kind::unwrapped || columns.kind == Kind::scaled_unwrapped || all_there(columns.image);
  for (std::int64_t row = 0; row < head.n_rows; ++row) {
    if (!in_.next() || in_.line().starts_with("ITEM:")) {
      in_.fail(fmt::format("the frame of step {} ends after {} of {} rows", frame.timestep, row, head.n_rows));
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
    if (!in_.next() || in_.line().starts_with("ITEM:") || in_.fields().size() < head.columns.n) {
      in_.fail(fmt::format("the frame of step {} ends after {} of {} rows", head.frame.timestep, row, head.n_rows));
    }
  }
}

/// Rows in ascending order of id.
std::vector<std::int64_t> order_by_id(const std::vector<std::int64_t>& ids) {
  std::vector<std::int64_t> order(ids.size());
  for (std::size_t row = 0; row < ids.size(); ++row) {
    order[row] = static_cast<std::int64_t>(row);
  }
  std::sort(order.begin(), order.end(), [&](std::int64_t a, std::int64_t b) { return ids[a] < ids[b]; });
  return order;
}

void print_box(OutputFile& out, const Box& box) {
  const bool is_tilted = box.xy() != 0.0 || box.xz() != 0.0 || box.yz() != 0.0;
  const double xy = box.xy(), xz = box.xz(), yz = box.yz();
  const Vector3 low = box.origin() + Vector3(std::min({0.0, xy, xz, xy + xz}), std::min(0.0, yz), 0.0);
  const Vector3 high = box.origin() + box.lengths() + Vector3(std::max({0.0, xy, xz, xy + xz}), std::max(0.0, yz), 0.0);
  out.print("ITEM: BOX BOUNDS{}", is_tilted ? " xy xz yz" : "");
  for (const bool periodic : box.periodic()) {
    out.print(" {}", periodic ? "pp" : "ff");
  }
  const std::array<double, 3> tilts = {xy, xz, yz};
  for (int axis = 0; axis < 3; ++axis) {
    out.print("\n{:.17g} {:.17g}", low[axis], high[axis]);
    if (is_tilted) {
      out.print(" {:.17g}", tilts[axis]);
    }
  }
  out.print("\n");
}

} // namespace

LammpsFrame read_lammps_dump(const std::filesystem::path& path, std::optional<std::int64_t> timestep) {
  // Which frame is the last is only known at the end, so its rows are read in a second pass.
  std::int64_t wanted = -1, n_frames = 0;
  DumpReader first_pass(path);
  while (const auto head = first_pass.next_head()) {
    if (timestep && head->frame.timestep == *timestep) {
      return first_pass.read_rows(*head);
    }
    first_pass.skip_rows(*head);
    wanted = n_frames++;
  }
  if (n_frames == 0) {
    first_pass.lines().fail_file("holds no frame");
  }
  if (timestep) {
    first_pass.lines().fail_file(fmt::format("has no frame of step {}", *timestep));
  }
  DumpReader second_pass(path);
  for (std::int64_t frame = 0; frame < wanted; ++frame) {
    second_pass.skip_rows(*second_pass.next_head());
  }
  return second_pass.read_rows(*second_pass.next_head());
}

std::vector<std::int64_t> lammps_dump_timesteps(const std::filesystem::path& path) {
  std::vector<std::int64_t> timesteps;
  DumpReader reader(path);
  while (const auto head = reader.next_head()) {
    reader.skip_rows(*head);
    timesteps.push_back(head->frame.timestep);
  }
  return timesteps;
}

std::vector<std::int64_t> rows_of_ids(const LammpsFrame& frame, std::span<const std::int64_t> wanted,
                                      const std::filesystem::path& path) {
  if (wanted.size() != frame.id.size()) {
    throw InputError(fmt::format("{}: {} atoms; {} are needed, the same as in the reference", path.string(),
                                 frame.id.size(), wanted.size()));
  }
  const IdTable table(frame.id);
  std::vector<std::int64_t> rows;
  rows.reserve(wanted.size());
  for (const std::int64_t id : wanted) {
    rows.push_back(table.row(id));
    if (rows.back() == IdTable::none) {
      throw InputError(fmt::format("{}: there is no atom {}, which the reference has", path.string(), id));
    }
  }
  return rows;
}

LammpsDumpWriter::LammpsDumpWriter(const std::filesystem::path& path, DumpLayout layout, FileMode mode)
    : file_(path, mode), layout_(layout) {}

void LammpsDumpWriter::write(const Topology& topology, const Snapshot& snapshot) {
  const bool has_velocity = !snapshot.velocity.empty();
  const bool is_for_forces = layout_ == DumpLayout::forces;
  file_.print("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\n", snapshot.step, topology.n_nodes());
  print_box(file_, snapshot.box);
  file_.print("ITEM: ATOMS {}\n", is_for_forces  ? "id x y z vx vy vz fx fy fz"
                                  : has_velocity ? "id mol type x y z ix iy iz vx vy vz"
                                                 : "id mol type x y z ix iy iz");
  const std::vector<int> grain_of = is_for_forces ? std::vector<int>{} : topology.grain_of_node();
  for (const std::int64_t node : order_by_id(topology.id)) {
    const Eigen::Vector3i n = snapshot.box.image_of(snapshot.position[node]);
    const Vector3 x = snapshot.position[node] - snapshot.box.h() * n.cast<double>();
    if (is_for_forces) {
      const Vector3& v = snapshot.velocity.at(node);
      const Vector3& f = snapshot.force.at(node);
      file_.print("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", topology.id[node],
                  x[0], x[1], x[2], v[0], v[1], v[2], f[0], f[1], f[2]);
      continue;
    }
    const int grain = grain_of[node];
    file_.print("{} {} {} {:.10g} {:.10g} {:.10g} {} {} {}", topology.id[node], topology.molecule[grain],
                topology.species[grain] + 1, x[0], x[1], x[2], n[0], n[1], n[2]);
    if (has_velocity) {
      const Vector3& v = snapshot.velocity[node];
      file_.print(" {:.10g} {:.10g} {:.10g}", v[0], v[1], v[2]);
    }
    file_.print("\n");
  }
  file_.flush();
}

std::int64_t truncate_lammps_dump(const std::filesystem::path& path, std::int64_t last_step) {
  if (path.extension() == ".gz") {
    throw InputError(fmt::format("{}: frames of a compressed dump cannot be cut off; give the dump a name without .gz",
                                 path.string()));
  }
  if (!std::filesystem::exists(path)) {
    return 0;
  }
  std::int64_t n_kept = 0;
  std::uint64_t length = 0;
  try {
    DumpReader reader(path);
    while (const auto head = reader.next_head()) {
      reader.skip_rows(*head);
      if (head->frame.timestep > last_step || !reader.lines().has_line_end()) {
        break;
      }
      length = reader.lines().bytes_read();
      ++n_kept;
    }
  } catch (const InputError&) {
    // A frame that was cut off by a killed run; a file that is no dump at all is left alone.
    LineReader lines(path);
    if (!lines.next() || !lines.line().starts_with("ITEM:")) {
      throw;
    }
  }
  cut_file(path, length);
  return n_kept;
}

} // namespace boba
