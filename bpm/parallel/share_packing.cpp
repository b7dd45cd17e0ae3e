// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/parallel/share_packing.h"

namespace boba {

namespace {

GrainTemplate shared(GrainTemplate grain, const Ranks& ranks) {
  ranks.broadcast(grain.position);
  ranks.broadcast(grain.bonds);
  bool has_period = grain.period.has_value();
  ranks.broadcast(has_period);
  Vector3 period = grain.period.value_or(Vector3::Zero());
  ranks.broadcast_bytes(period.data(), 3 * sizeof(double));
  grain.period = has_period ? std::optional<Eigen::Vector3d>(period) : std::nullopt;
  ranks.broadcast(grain.reference_volume);
  return grain;
}

Box shared(const Box& box, const Ranks& ranks) {
  Vector3 origin = box.origin();
  Matrix3 h = box.h();
  std::array<bool, 3> periodic = box.periodic();
  ranks.broadcast_bytes(origin.data(), 3 * sizeof(double));
  ranks.broadcast_bytes(h.data(), 9 * sizeof(double));
  ranks.broadcast(periodic);
  Box result(origin, h.diagonal(), Vector3::Zero(), periodic);
  result.set_h(h);
  return result;
}

} // namespace

void share_packing(Packing& packing, const Ranks& ranks) {
  if (!ranks.is_distributed()) {
    return;
  }
  packing.box = shared(packing.box, ranks);
  std::size_t n_templates = packing.templates.size();
  ranks.broadcast(n_templates);
  packing.templates.resize(n_templates);
  for (auto& grain : packing.templates) {
    grain = std::make_shared<const GrainTemplate>(shared(grain ? *grain : GrainTemplate{}, ranks));
  }
  ranks.broadcast(packing.grains);
  ranks.broadcast(packing.id);
  ranks.broadcast(packing.position);
  ranks.broadcast(packing.velocity);
  ranks.broadcast(packing.strain);
  ranks.broadcast(packing.walls);
}

} // namespace boba
