// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/dynamics/sound_motion.h"

#include "bpm/dynamics/blow_up.h"
#include "bpm/dynamics/blow_up_checks.h"
#include "bpm/grain/sound_template.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument("the state of the run: " + what);
}

void check_nodes(const MovingPacking& moving) {
  for (const int grain : moving.layout.grains()) {
    for (int node = 0; node < moving.layout.n_nodes(grain); ++node) {
      const Vector3 x = moving.state.position(grain, node), v = moving.state.velocity(grain, node);
      const bool is_sound =
          is_usable_position(x) && is_usable_position(v) && moving.state.force(grain, node).allFinite();
      if (!is_sound) {
        refuse(
            fmt::format("node {} of grain {} is at {:g} {:g} {:g} d with a velocity of {:g} {:g} {:g} d/tau; allowed: "
                        "{:g} to {:g}, and finite forces",
                        node, grain, x[0], x[1], x[2], v[0], v[1], v[2], -largest_coordinate, largest_coordinate));
      }
    }
  }
}

void check_cell(const MovingCell& cell) {
  const MovingCell::Saved saved = cell.saved();
  for (const Matrix3* h : {&saved.h, &saved.evaluated_h}) {
    const bool is_upper = (*h)(1, 0) == 0.0 && (*h)(2, 0) == 0.0 && (*h)(2, 1) == 0.0;
    if (!is_upper || !(h->diagonal().minCoeff() > 0.0) || !is_usable_position(h->cwiseAbs().rowwise().sum())) {
      refuse("the cell's vectors are not those of a cell");
    }
  }
  for (const Matrix3* m :
       {&saved.map, &saved.position_map, &saved.residual_rate, &saved.streaming, &saved.next_streaming}) {
    if (!m->allFinite()) {
      refuse("the cell moves at a rate that is not a finite number");
    }
  }
  if (!std::isfinite(saved.strain)) {
    refuse(fmt::format("a strain of {}", saved.strain));
  }
}

void check_ends(const MovingPacking& moving) {
  for (const Wall& wall : moving.forces.walls()) {
    if (!is_usable_position(wall.point) || !wall.normal.allFinite() || !wall.velocity.allFinite()) {
      refuse("a wall without a place");
    }
  }
  for (const Clamp& clamp : moving.ends.clamps()) {
    bool is_sound = clamp.grain.size() == clamp.node.size() && clamp.velocity.allFinite();
    for (std::size_t k = 0; is_sound && k < clamp.grain.size(); ++k) {
      is_sound = clamp.grain[k] >= 0 && clamp.grain[k] < moving.layout.n_grains() && clamp.node[k] >= 0 &&
                 clamp.node[k] < moving.packing.template_of(static_cast<int>(clamp.grain[k])).n_nodes();
    }
    if (!is_sound) {
      refuse("a clamp holds nodes that are not there");
    }
  }
}

} // namespace

void check_motion(const MovingPacking& moving) {
  moving.ranks().collectively([&] {
    if (moving.step < 0) {
      refuse(fmt::format("step {}", moving.step));
    }
    check_nodes(moving);
    check_cell(moving.cell);
    check_ends(moving);
  });
  const Stretch stretch = largest_stretch(moving);
  if (!(stretch.ratio <= largest_bond_stretch)) {
    refuse(fmt::format("a bond of node {} of grain {} is {:.3g} times as long as at rest; allowed: {:g}", stretch.node,
                       stretch.grain, stretch.ratio, largest_bond_stretch));
  }
}

} // namespace boba
