// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/insert.h"

#include "bpm/packing/insertion.h"
#include "bpm/scene/schema.h"

#include <fmt/format.h>

namespace boba {

SceneSection InsertStart::section() {
  return {"stage",
          "insert",
          true,
          "Places all grains at random, without overlap and at random angles, in a cubic periodic cell. First stage "
          "only.",
          {real_key("packing_fraction", "", 1e-9, 0.74, "0.4",
                    "sum of the grains' reference volumes over the cell's volume"),
           boolean_key("rotate", "true", "turn every grain at random")}};
}

InsertStart::InsertStart(const SceneTable& table, const StartFiles&)
    : packing_fraction_(table.real("packing_fraction", 0.4)), rotate_(table.boolean("rotate", true)) {}

void InsertStart::check(const SceneTable& table, const SceneGrains& grains) const {
  for (const SceneTemplate& t : grains.templates) {
    if (t.spec.shape == TemplateSpec::Shape::periodic_box) {
      table.fail("type", fmt::format("cannot place the template \"{}\": a periodic_box has no surface; use a "
                                     "\"specimen\" stage",
                                     t.name));
    }
  }
}

Packing InsertStart::make(const StartContext& context) const {
  context.narrate(fmt::format("placing {} grains at random", context.grains.size()));
  Insertion insertion;
  insertion.templates = context.templates;
  insertion.grains = context.grains;
  insertion.packing_fraction = packing_fraction_;
  insertion.rotate = rotate_;
  insertion.seed = context.seed;
  insertion.diameter = context.material.diameter;
  return insert_at_random(insertion);
}

} // namespace boba
