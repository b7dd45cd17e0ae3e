// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/measure/qhull_oracle.h"

#include <stdexcept>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace boba::test_data {

QhullResult qhull(std::span<const Vector3> points) {
  qhT state;
  qhT* qh = &state;
  qh_zero(qh, stderr);
  char options[] = "qhull Qt FA";
  auto* coordinates = const_cast<coordT*>(points.front().data()); // Qhull reads only: not allowed to free them
  if (qh_new_qhull(qh, 3, static_cast<int>(points.size()), coordinates, False, options, nullptr, stderr) != 0) {
    throw std::runtime_error("Qhull failed");
  }
  qh_getarea(qh, qh->facet_list);
  QhullResult result{qh->totvol, qh->totarea, {}};
  vertexT* vertex = nullptr;
  FORALLvertices {
    result.vertices.insert(qh_pointid(qh, vertex->point));
  }
  qh_freeqhull(qh, !qh_ALL);
  int n_long = 0, long_bytes = 0;
  qh_memfreeshort(qh, &n_long, &long_bytes);
  return result;
}

} // namespace boba::test_data
