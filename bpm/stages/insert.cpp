// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/insert.h"

#include "bpm/toml/schema.h"

#include <fmt/format.h>
#include <stdexcept>

namespace boba {

SceneSection InsertStart::section() {
  return {
      "stage",
      "insert",
      true,
      "Places all grains at random, without overlap and at random angles, in a cubic periodic cell, or on the "
      "sites of a crystal. First stage only.",
      {real_key("packing_fraction", "", 1e-9, 0.74, "0.4",
                "sum of the grains' reference volumes over the cell's volume"),
       choice_key("arrangement", arrangement_names(), "\"random\"",
                  "where the grains are placed: fcc takes 4 n^3 of them, bcc 2 n^3, sc n^3; hcp numbers that make a "
                  "cell near a cube; others are refused with the next that fit"),
       boolean_key("rotate", "true", "turn every grain at random")}};
}

InsertStart::InsertStart(const SceneTable& table, const StartFiles&)
    : packing_fraction_(table.real("packing_fraction", 0.4)), rotate_(table.boolean("rotate", true)),
      arrangement_(arrangement_named(table.text("arrangement", "random"))) {}

void InsertStart::check(const SceneTable& table, const SceneGrains& grains) const {
  for (const SceneTemplate& t : grains.templates) {
    if (t.spec.shape == TemplateSpec::Shape::periodic_box) {
      table.fail("type", fmt::format("cannot place the template \"{}\": a periodic_box has no surface; use a "
                                     "\"specimen\" stage",
                                     t.name));
    }
  }
  std::int64_t count = 0;
  for (const SceneSpecies& species : grains.species) {
    count += species.count;
  }
  try {
    check_lattice_count(arrangement_, count);
  } catch (const std::invalid_argument& error) {
    table.fail("arrangement", error.what());
  }
}

Packing InsertStart::make(const StartContext& context) const {
  const bool at_random = arrangement_ == Arrangement::random;
  context.narrate(fmt::format("placing {} grains {}", context.grains.size(),
                              at_random ? "at random" : fmt::format("on a lattice ({})", name_of(arrangement_))));
  Insertion insertion;
  insertion.templates = context.templates;
  insertion.grains = context.grains;
  insertion.packing_fraction = packing_fraction_;
  insertion.rotate = rotate_;
  insertion.seed = context.seed;
  insertion.diameter = between_grains(context.material).diameter;
  return at_random ? insert_at_random(insertion) : insert_on_lattice(insertion, arrangement_);
}

} // namespace boba
