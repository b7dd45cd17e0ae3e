// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/lammps_start.h"

#include "bpm/io/input_error.h"
#include "bpm/io/lammps_dump.h"
#include "bpm/io/lammps_packing.h"
#include "bpm/scene/schema.h"

#include <fmt/format.h>

namespace boba {

SceneSection LammpsStart::section() {
  return {"start",
          "",
          false,
          "a LAMMPS data file of undeformed bonded grains (bond rest lengths from there) with the state of a dump file",
          {text_key("lammps_reference", "", "LAMMPS data file, also .gz"),
           text_key("lammps_state", "the reference itself",
                    "LAMMPS dump (or data) file with the present state, also .gz")}};
}

LammpsStart::LammpsStart(const SceneTable& table, const StartFiles& files)
    : reference_(files.file(table, "lammps_reference")), frame_(static_cast<int>(table.integer("frame", -1))),
      material_(read_alpha(table, false)) {
  if (table.has("lammps_state")) {
    state_ = files.file(table, "lammps_state");
  }
}

/// Time step of the frame that a scene counts from 0, or from the end; none for the last.
std::optional<std::int64_t> LammpsStart::timestep() const {
  if (frame_ == -1 || !state_) {
    return std::nullopt;
  }
  const std::vector<std::int64_t> steps = lammps_dump_timesteps(*state_);
  const auto n = static_cast<std::int64_t>(steps.size());
  const std::int64_t number = frame_ < 0 ? n + frame_ : frame_;
  if (number < 0 || number >= n) {
    throw InputError(fmt::format("{}: start.frame = {}: the file has {} frames; allowed: {} to {}", state_->string(),
                                 frame_, n, -n, n - 1));
  }
  return steps[static_cast<std::size_t>(number)];
}

Packing LammpsStart::make(const StartContext& context) const {
  context.narrate("reading " + reference_.string());
  Packing packing = read_lammps_packing({reference_, state_, timestep()}).packing;
  const double alpha = context.alpha(material_);
  for (Grain& grain : packing.grains) {
    grain.alpha = alpha;
  }
  return packing;
}

} // namespace boba
