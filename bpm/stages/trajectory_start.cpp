// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/trajectory_start.h"

#include "bpm/io/trajectory_packing.h"
#include "bpm/toml/schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>

namespace boba {

namespace {

/// The coefficients that a trajectory stores, "alpha = -1, 2 k d".
std::string told_alphas(const Packing& packing) {
  std::set<double> alphas;
  for (const Grain& grain : packing.grains) {
    alphas.insert(grain.alpha);
  }
  constexpr std::size_t most_told = 4;
  return alphas.size() > most_told ? fmt::format("{} values of alpha", alphas.size())
                                   : fmt::format("alpha = {:g} k d", fmt::join(alphas, ", "));
}

std::size_t n_species(const Packing& packing) {
  std::set<int> species;
  for (const Grain& grain : packing.grains) {
    species.insert(grain.species);
  }
  return species.size();
}

} // namespace

SceneSection TrajectoryStart::section() {
  return {"start",
          "",
          false,
          "a frame of a trajectory that Boba wrote",
          {text_key("trajectory", "",
                    "trajectory.h5 of an earlier run. Its constants of [material] apply too, but for those that this "
                    "scene gives"),
           real_key("strain", "", -1e9, 1e9, "as stored with the trajectory",
                    "shear strain that the run begins with: of its tables and intervals of output")}};
}

TrajectoryStart::TrajectoryStart(const SceneTable& table, const StartFiles& files)
    : file_(files.file(table, "trajectory")), frame_(static_cast<int>(table.integer("frame", -1))),
      material_(read_alpha(table, false)), strain_(table.maybe_real("strain")), breaking_(read_breaking(table)),
      yielding_(read_yielding(table)) {}

Packing TrajectoryStart::make(const StartContext& context) const {
  context.narrate("reading " + file_.string());
  Packing packing = read_trajectory_packing(file_, frame_);
  const std::string stored = told_alphas(packing);
  if (material_.alpha || material_.poisson) {
    const double alpha = context.alpha(material_);
    for (Grain& grain : packing.grains) {
      grain.alpha = alpha;
    }
    const std::string given = material_.alpha ? fmt::format("start.alpha = {:g}", *material_.alpha)
                                              : fmt::format("start.poisson = {:g}", *material_.poisson);
    const std::size_t species = n_species(packing);
    context.narrate(fmt::format("{}{} applies to all {} grains{}, instead of {} of the trajectory",
                                species > 1 ? "warning: " : "", given, packing.n_grains(),
                                species > 1 ? fmt::format(" of {} species", species) : "", stored));
  } else {
    context.narrate(stored + " of the trajectory");
  }
  context.narrate(strain_ ? fmt::format("start.strain = {:g}, instead of {:g} of the frame", *strain_, packing.strain)
                          : fmt::format("strain {:g} of the frame", packing.strain));
  packing.strain = strain_.value_or(packing.strain);
  for (Grain& grain : packing.grains) {
    grain.breaking = breaking_;
    grain.breaking.seed = context.seed;
    grain.yielding = yielding_;
  }
  return packing;
}

} // namespace boba
