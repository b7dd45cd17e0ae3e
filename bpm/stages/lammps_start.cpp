// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/lammps_start.h"

#include "bpm/io/lammps_packing.h"
#include "bpm/toml/schema.h"

#include <utility>

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
      material_(read_alpha(table, false)), breaking_(read_breaking(table)), yielding_(read_yielding(table)) {
  if (table.has("lammps_state")) {
    state_ = files.file(table, "lammps_state");
  }
}

Packing LammpsStart::make(const StartContext& context) const {
  context.narrate("reading " + reference_.string());
  LammpsPacking read = read_lammps_packing({reference_, state_, std::nullopt, frame_});
  if (!read.warning.empty()) {
    context.narrate("warning: " + read.warning);
  }
  Packing packing = std::move(read.packing);
  const double alpha = context.alpha(material_);
  for (Grain& grain : packing.grains) {
    grain.alpha = alpha;
    grain.breaking = breaking_;
    grain.breaking.seed = context.seed;
    grain.yielding = yielding_;
  }
  return packing;
}

} // namespace boba
