// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/scaling/repeat_packing.h"

namespace boba::bench {

Packing repeated(const Packing& packing, const std::array<int, 3>& times) {
  Packing result;
  result.templates = packing.templates;
  Matrix3 h = packing.box.h();
  for (int axis = 0; axis < 3; ++axis) {
    h.col(axis) *= times[axis];
  }
  result.box = packing.box;
  result.box.set_h(h);
  for (int c = 0; c < times[2]; ++c) {
    for (int b = 0; b < times[1]; ++b) {
      for (int a = 0; a < times[0]; ++a) {
        const Vector3 shift = packing.box.h() * Vector3(a, b, c);
        for (Grain grain : packing.grains) {
          grain.molecule = result.n_grains() + 1;
          result.grains.push_back(grain);
        }
        for (const Vector3& x : packing.position) {
          result.position.push_back(x + shift);
          result.id.push_back(static_cast<std::int64_t>(result.position.size()));
        }
        result.velocity.insert(result.velocity.end(), packing.velocity.begin(), packing.velocity.end());
      }
    }
  }
  return result;
}

} // namespace boba::bench
