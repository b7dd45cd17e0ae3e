// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

#include <vector>

namespace boba::calibration {

/// What lies between a plate and the solid behind a flat cut face: p = c1 g + c3 g^3 of the overlap g of the plate and a surface
/// that lies `beyond` outside the cut. Beyond that surface's own layer the body is the bulk.
struct FlatSurface {
  double beyond = 0.0;   ///< d, from the plane of the cut outward; d/2 would be nodes that all lie in the plane
  double c1 = 0.0;       ///< k/d^2
  double c3 = 0.0;       ///< k/d^4
  double residual = 0.0; ///< d: root mean square misfit of the overlap
  double largest_pressure = 0.0; ///< k/d, up to which it was fitted
};

/// One state of a slab between walls.
struct SlabState {
  double pressure = 0.0; ///< k/d
  double gap = 0.0;      ///< distance of the walls, d
  double bulk_stretch = 1.0; ///< of the uncut bulk along z at that pressure, held across
};

/// Cuts the periodic box across z, presses the slab between two rigid walls with its width held, and takes off what the uncut
/// bulk gives at the same pressure. `thickness` of the slab is the box's length along z.
std::vector<SlabState> press_slab(const GrainTemplate& box, double alpha, double largest_pressure);

/// The layer that, on a body of the bulk's stretch, is nearest to the states of all slabs (least squares in the overlap).
/// \throws std::runtime_error when no layer with c1 > 0 fits.
FlatSurface fit_surface(const std::vector<SlabState>& states, double thickness);

} // namespace boba::calibration
