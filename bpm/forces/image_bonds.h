// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/forces/network_data.h"
#include "bpm/laws/bond.h"
#include "bpm/packing/box.h"

namespace boba {

/// Virial of the bonds across the boundary, per lane, as xx yy zz xy xz yz.
struct ImageBondSums {
  double virial[6][max_lanes];
};

/// Adds the forces of the bonds of a periodic template that cross the boundary. They are a small share of a
/// calibration cube's bonds, so they are evaluated one by one, apart from the hot loop.
///
/// With `many_body` the node volumes that the forces need are those of *all* bonds: on return `arrays.volume` holds the
/// image bonds' part, to which the hot loop adds its own.
ImageBondSums add_image_bonds(const NetworkData& network, const BondLaw& law, const Box& box,
                              const Matrix3& residual_rate, bool many_body, kernels::BlockArrays& arrays);

} // namespace boba
