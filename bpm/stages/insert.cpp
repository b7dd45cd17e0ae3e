// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/insert.h"

#include "bpm/laws/hertz.h"
#include "bpm/packing/node_insertion.h"
#include "bpm/toml/schema.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <new>
#include <stdexcept>

namespace boba {

SceneSection InsertStart::section() {
  return {
      "stage",
      "insert",
      true,
      "Places all grains at random, without overlap and at random angles, in a cubic periodic cell, or on the "
      "sites of a crystal. Grains that are far from spheres come as near to each other as their nodes allow. First "
      "stage only.",
      {real_key("packing_fraction", "", 1e-9, 0.74, "0.4; at random, or the next lower in steps of 5 % that works",
                "sum of the grains' reference volumes over the cell's volume"),
       choice_key("arrangement", arrangement_names(), "\"random\"",
                  "where the grains are placed: fcc takes 4 n^3 of them, bcc 2 n^3, sc n^3; hcp numbers that make a "
                  "cell near a cube; others are refused with the next that fit"),
       boolean_key("rotate", "true", "turn every grain at random"),
       choice_key("walls", {"none", "z", "xyz"}, "\"none\"",
                  "rigid walls at the faces of the cell across z, or all round, along which the cell is then open; it "
                  "grows there to hold the grains whole")}};
}

InsertStart::InsertStart(const SceneTable& table, const StartFiles&)
    : packing_fraction_(table.real("packing_fraction", 0.4)), may_lower_(!table.has("packing_fraction")),
      rotate_(table.boolean("rotate", true)), arrangement_(arrangement_named(table.text("arrangement", "random"))) {
  const std::string walls = table.text("walls", "none");
  walls_ = {walls == "xyz", walls == "xyz", walls != "none"};
}

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

namespace {

/// Grains that are far from spheres are placed by their nodes where their bounding spheres find no room.
Packing insert_by_shape(const Insertion& insertion) {
  try {
    return insert_at_random(insertion);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    if (are_round(insertion)) {
      throw;
    }
  }
  return insert_by_nodes(insertion);
}

/// Places the grains; `may_lower` steps down by 5 % where random placement does not reach the fraction (the spheres
/// around cut grains are larger than what they enclose).
Packing insert_where_possible(Insertion insertion, bool may_lower, const Narrator& narrate) {
  constexpr double step = 0.95, lowest = 0.1;
  while (true) {
    try {
      return insert_by_shape(insertion);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) { // the spheres fill too much, or do not come to rest; not all grains find a place
      if (!may_lower || insertion.packing_fraction < lowest) {
        throw;
      }
    }
    insertion.packing_fraction *= step;
    narrate(
        fmt::format("too dense to be placed at random; trying packing_fraction = {:.4g}", insertion.packing_fraction));
  }
}

/// Opens the cell along some axes: it then ends, with walls, where the outermost nodes begin to feel them.
Packing between_walls(Packing packing, const std::array<bool, 3>& walls, double reach) {
  Vector3 low = packing.box.origin(), high = low + packing.box.lengths();
  std::array<bool, 3> periodic = packing.box.periodic();
  for (int axis = 0; axis < 3; ++axis) {
    if (!walls[axis]) {
      continue;
    }
    periodic[axis] = false;
    low[axis] = std::numeric_limits<double>::infinity();
    high[axis] = -low[axis];
    for (const Vector3& x : packing.position) {
      low[axis] = std::min(low[axis], x[axis] - reach);
      high[axis] = std::max(high[axis], x[axis] + reach);
    }
  }
  packing.box = Box(low, high - low, Vector3::Zero(), periodic);
  packing.walls = walls;
  return packing;
}

} // namespace

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
  if (walls_[2] && context.material.contact == HertzLaw::name) {
    throw std::invalid_argument(
        "insert: walls have no meaning with material.hertz_modulus: Hertz's law is for contacts "
        "of two spheres");
  }
  const double reach = 0.5 * insertion.diameter;
  Packing packing = at_random ? insert_where_possible(std::move(insertion), may_lower_, context.narrate)
                              : insert_on_lattice(insertion, arrangement_);
  return walls_[2] ? between_walls(std::move(packing), walls_, reach) : packing;
}

} // namespace boba
