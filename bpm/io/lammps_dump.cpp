// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/lammps_dump.h"

#include "bpm/io/id_table.h"
#include "bpm/io/lammps_dump_reader.h"

#include <algorithm>
#include <fmt/format.h>

namespace boba {

using lammps::DumpReader;

namespace {

/// Frames that are whole, in the file's order, and why what follows them is none.
struct DumpIndex {
  std::vector<std::int64_t> timestep;
  std::string cut_off;
};

/// \throws InputError when a frame is wrong, or when no frame is whole.
DumpIndex index_of(const std::filesystem::path& path) {
  DumpIndex index;
  DumpReader reader(path);
  try {
    while (const auto head = reader.next_head()) {
      reader.skip_rows(*head);
      index.timestep.push_back(head->frame.timestep);
    }
  } catch (const CutOff& error) {
    if (index.timestep.empty()) {
      throw;
    }
    index.cut_off = error.what();
  }
  if (index.timestep.empty()) {
    reader.lines().fail_file("holds no frame");
  }
  return index;
}

/// Which frame is the last is only known at the end, so its rows are read in a second pass.
LammpsFrame read_frame(const std::filesystem::path& path, std::int64_t number, const DumpIndex& index) {
  DumpReader reader(path);
  for (std::int64_t frame = 0; frame < number; ++frame) {
    reader.skip_rows(*reader.next_head());
  }
  LammpsFrame frame = reader.read_rows(*reader.next_head());
  frame.cut_off = index.cut_off;
  return frame;
}

} // namespace

LammpsFrame read_lammps_dump(const std::filesystem::path& path, std::optional<std::int64_t> timestep) {
  const DumpIndex index = index_of(path);
  if (!timestep) {
    return read_frame(path, std::ssize(index.timestep) - 1, index);
  }
  const auto found = std::find(index.timestep.begin(), index.timestep.end(), *timestep);
  if (found == index.timestep.end()) {
    throw InputError(fmt::format("{}: has no frame of step {}", path.string(), *timestep));
  }
  const auto again = std::find(found + 1, index.timestep.end(), *timestep);
  if (again != index.timestep.end()) {
    throw InputError(fmt::format("{}: frames {} and {} are both of step {}; give the frame by its number",
                                 path.string(), found - index.timestep.begin(), again - index.timestep.begin(),
                                 *timestep));
  }
  return read_frame(path, found - index.timestep.begin(), index);
}

LammpsFrame read_lammps_dump_frame(const std::filesystem::path& path, std::int64_t number) {
  const DumpIndex index = index_of(path);
  const std::int64_t n = std::ssize(index.timestep), from_begin = number < 0 ? n + number : number;
  if (from_begin < 0 || from_begin >= n) {
    throw InputError(fmt::format("{}: frame = {}: the file has {} {}frames; allowed: {} to {}", path.string(), number,
                                 n, index.cut_off.empty() ? "" : "whole ", -n, n - 1));
  }
  return read_frame(path, from_begin, index);
}

std::vector<std::int64_t> lammps_dump_timesteps(const std::filesystem::path& path) {
  return index_of(path).timestep;
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
