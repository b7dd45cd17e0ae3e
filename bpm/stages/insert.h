// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/lattice_insertion.h"
#include "bpm/stages/start.h"

#include <array>

namespace boba {

/// A first [[stage]] with `type = "insert"`: all grains without overlap in a periodic cell, at random or on the sites
/// of a crystal.
/// With walls the cell is open along their axes and ends at them.
class InsertStart : public StartEntry {
public:
  static SceneSection section();
  InsertStart(const SceneTable& table, const StartFiles& files);

  void check(const SceneTable& table, const SceneGrains& grains) const override;
  bool cell_is_open(const SceneGrains&) const override { return walls_[2]; }
  Packing make(const StartContext& context) const override;
  double packing_fraction() const { return packing_fraction_; }

private:
  double packing_fraction_; ///< sum of reference volumes over cell volume
  bool may_lower_;          ///< the scene leaves it open
  bool rotate_;
  std::array<bool, 3> walls_{}; ///< across which axes; z wherever there are any
  Arrangement arrangement_;
};

} // namespace boba
