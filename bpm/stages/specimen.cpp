// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/specimen.h"

#include "base/bounds.h"
#include "bpm/packing/insertion.h"
#include "bpm/toml/schema.h"

namespace boba {

SceneSection SpecimenStart::section() {
  return {"stage",
          "specimen",
          true,
          "Places one grain as it is in the middle of an open cell (a `periodic_box`: in its own cell). First stage "
          "only.",
          {above_key("margin", "d", 0.0, 1e4, "5", "free space around the grain")}};
}

SpecimenStart::SpecimenStart(const SceneTable& table, const StartFiles&) : margin_(table.real("margin", 5.0)) {}

void SpecimenStart::check(const SceneTable& table, const SceneGrains& grains) const {
  if (grains.species.size() > 1 || grains.species.front().count > 1) {
    table.fail("type", "takes one species with count = 1");
  }
}

bool SpecimenStart::cell_is_open(const SceneGrains& grains) const {
  return grains.templates[grains.species.front().template_index].spec.shape != TemplateSpec::Shape::periodic_box;
}

Packing SpecimenStart::make(const StartContext& context) const {
  const Grain& grain = context.grains.front();
  const GrainTemplate& shape = *context.templates[grain.template_index];
  const std::vector<Placement> placed = {{grain, Vector3::Zero(), Eigen::Quaterniond::Identity()}};
  if (shape.period) {
    return make_packing(Box(-0.5 * *shape.period, *shape.period), context.templates, placed);
  }
  const Bounds around = bounds_of(shape.position).widened(margin_);
  return make_packing(Box(around.low, around.extent(), Vector3::Zero(), {false, false, false}), context.templates,
                      placed);
}

} // namespace boba
