// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stepper.h"

#include <memory>

namespace boba::bench {

/// A packing at P~ = 0.1, ready to be sheared: grains inserted at random at a packing fraction of 0.38 and compressed.
struct DensePacking {
  std::unique_ptr<Stepper> stepper;
  double pressure = 0.0; ///< target, k/d
  double gain = 0.0;     ///< of the barostat, d/(k tau)
};

/// \param n_nodes per grain; \param alpha 0 or 2, for which the published E and nu give P from P~
DensePacking make_dense_packing(int n_grains, int n_nodes, double alpha, int threads);

} // namespace boba::bench
