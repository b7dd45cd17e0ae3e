// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/trajectory_start.h"

#include "bpm/io/trajectory_packing.h"
#include "bpm/toml/schema.h"

namespace boba {

SceneSection TrajectoryStart::section() {
  return {"start",
          "",
          false,
          "a frame of a trajectory that Boba wrote",
          {text_key("trajectory", "", "trajectory.h5 of an earlier run")}};
}

TrajectoryStart::TrajectoryStart(const SceneTable& table, const StartFiles& files)
    : file_(files.file(table, "trajectory")), frame_(static_cast<int>(table.integer("frame", -1))),
      material_(read_alpha(table, false)), breaking_(read_breaking(table)) {}

Packing TrajectoryStart::make(const StartContext& context) const {
  context.narrate("reading " + file_.string());
  const bool is_given = material_.alpha || material_.poisson;
  Packing packing =
      read_trajectory_packing(file_, frame_, is_given ? std::optional(context.alpha(material_)) : std::nullopt);
  for (Grain& grain : packing.grains) {
    grain.breaking = breaking_;
    grain.breaking.seed = context.seed;
  }
  return packing;
}

} // namespace boba
