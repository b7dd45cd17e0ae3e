// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/start.h"

namespace boba {

/// A first [[stage]] with `type = "specimen"`: one grain as it is, in an open cell or, when it is periodic, in its own.
class SpecimenStart : public StartEntry {
public:
  static SceneSection section();
  SpecimenStart(const SceneTable& table, const StartFiles& files);

  void check(const SceneTable& table, const SceneGrains& grains) const override;
  bool cell_is_open(const SceneGrains& grains) const override;
  Packing make(const StartContext& context) const override;

private:
  double margin_; ///< d
};

} // namespace boba
