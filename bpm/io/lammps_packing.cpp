// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/lammps_packing.h"

#include "bpm/io/lammps_data.h"
#include "bpm/io/lammps_dump.h"
#include "bpm/io/line_reader.h"
#include "bpm/io/naming.h"
#include "bpm/packing/sound_packing.h"
#include "bpm/packing/whole_grains.h"

#include <fmt/format.h>

namespace boba {

namespace {

/// Every mass of the engine is 1 m; another one in a file would be ignored in silence.
void check_masses(const LammpsData& data, const std::filesystem::path& path) {
  for (const double mass : data.mass) {
    if (mass != 1.0) {
      throw InputError(fmt::format("{}: section 'Masses' gives {}; every node's mass must be 1", path.string(), mass));
    }
  }
}

bool is_dump(const std::filesystem::path& path) {
  LineReader lines(path);
  return lines.next_with_fields() && lines.line().starts_with("ITEM:");
}

LammpsFrame frame_of(LammpsData data) {
  LammpsFrame frame;
  frame.timestep = data.timestep;
  frame.box = data.box;
  frame.is_unwrapped = data.has_images;
  frame.id = std::move(data.id);
  frame.position = std::move(data.position);
  frame.velocity = std::move(data.velocity);
  return frame;
}

LammpsFrame read_state(const LammpsSource& source) {
  const std::filesystem::path& path = *source.state;
  if (is_dump(path)) {
    return source.frame ? read_lammps_dump_frame(path, *source.frame) : read_lammps_dump(path, source.timestep);
  }
  if (source.frame.value_or(-1) != -1 && *source.frame != 0) {
    throw InputError(
        fmt::format("{}: frame = {}: a data file has one; allowed: 0 and -1", path.string(), *source.frame));
  }
  LammpsData data = read_lammps_data(path);
  check_masses(data, path);
  return frame_of(std::move(data));
}

} // namespace

LammpsPacking read_lammps_packing(const LammpsSource& source) {
  LammpsData reference = read_lammps_data(source.reference);
  check_masses(reference, source.reference);
  GroupedNetwork grouped = naming(source.reference, [&] {
    return group_network(
        {reference.box, reference.id, reference.molecule, reference.type, reference.position, reference.bond_rows()});
  });
  const std::filesystem::path path = source.state.value_or(source.reference);
  const LammpsFrame state = source.state ? read_state(source) : frame_of(std::move(reference));
  LammpsPacking result{std::move(grouped.packing), std::move(grouped.row), state.timestep, {}};
  if (!state.cut_off.empty()) {
    result.warning = fmt::format("{}; taken is the frame of step {}, which is whole", state.cut_off, state.timestep);
  }
  Packing& packing = result.packing;
  const std::vector<std::int64_t> rows = rows_of_ids(state, packing.id, path);
  for (std::size_t node = 0; node < rows.size(); ++node) {
    packing.position[node] = state.position[rows[node]];
    packing.velocity[node] = state.velocity.empty() ? Vector3(Vector3::Zero()) : state.velocity[rows[node]];
  }
  packing.box = state.box;
  packing.position = naming(path, [&] { return whole_positions(packing, packing.box, packing.position); });
  naming(path, [&] { check_sound(packing); });
  return result;
}

} // namespace boba
