// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/calibration/test_boxes.h"

#include "bpm/grain/bond_network.h"
#include "bpm/grain/near_pairs.h"
#include "bpm/grain/template_cache.h"

#include <cmath>

namespace boba::calibration {

using Eigen::Vector3d;

GrainTemplate test_box(int n_nodes, std::uint64_t seed) {
  return TemplateCache(BOBA_TEST_CACHE)
      .get({.shape = TemplateSpec::Shape::periodic_box, .size = {1, 1, 1}, .n_nodes = n_nodes, .seed = seed});
}

GrainTemplate test_cylinder(double radius, double height) {
  return TemplateCache(BOBA_TEST_CACHE)
      .get({.shape = TemplateSpec::Shape::cylinder, .radius = radius, .height = height});
}

GrainTemplate fcc_box(int m) {
  const double half_cell = std::sqrt(0.5);
  GrainTemplate box;
  box.period = Vector3d::Constant(2 * m * half_cell);
  for (int ix = 0; ix < 2 * m; ++ix) {
    for (int iy = 0; iy < 2 * m; ++iy) {
      for (int iz = 0; iz < 2 * m; ++iz) {
        if ((ix + iy + iz) % 2 == 0) {
          box.position.push_back(wrapped(half_cell * Vector3d(ix, iy, iz), *box.period));
        }
      }
    }
  }
  box.bonds = bonds_closer_than(box.position, 1.2, box.period);
  box.reference_volume = box.period->prod();
  return box;
}

} // namespace boba::calibration
