// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/packing/lane_state.h"

#include <type_traits>

namespace boba {

/// The kernels of a table that compute in these numbers, double or float.
template <class Real> const auto& kernels_in(const kernels::KernelTable& table) {
  if constexpr (std::is_same_v<Real, float>) {
    return table.mixed;
  } else {
    return table.precise;
  }
}

/// The kernels of a table that belong to arrays of this kind.
template <class Coordinate, class Real>
const kernels::LaneKernels<Coordinate, Real>& kernels_of(const kernels::KernelTable& table,
                                                         const LaneArrays<Coordinate, Real>&) {
  return kernels_in<Real>(table);
}

} // namespace boba
