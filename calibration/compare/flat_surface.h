// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"

#include <vector>

namespace boba::calibration {

/// What lies between a plate and the solid behind a flat cut face.
///
/// The solid ends where its bonds end: the body of the slab is as thick as its bond stiffness (sum of r0^2) makes of
/// the bulk, which is about 0.3 d less than the cut on each face. Beyond it lies a layer of thickness `beyond`, which
/// carries p = c1 g + c3 g^3 at the overlap g of plate and layer. Roughness of the cut, wall springs of single nodes,
/// their soft support and missing bonds are all in it.
struct FlatSurface {
  double beyond = 0.0;           ///< d, from where the bonds end to where the layer meets a plate
  double c1 = 0.0;               ///< k/d^2
  double c3 = 0.0;               ///< k/d^4
  double residual = 0.0;         ///< d: root mean square misfit of the overlap
  double largest_pressure = 0.0; ///< k/d, up to which it was fitted
};

/// One state of a slab between walls.
struct SlabState {
  double pressure = 0.0;     ///< k/d
  double gap = 0.0;          ///< distance of the walls, d
  double bulk_stretch = 1.0; ///< of the uncut bulk along z at that pressure, held across
  double body = 0.0;         ///< undeformed thickness of the slab by its bonds, d
  /// Of plate and undeformed body, d: what the layer takes up.
  double beyond_body() const { return 0.5 * (gap - body * bulk_stretch); }
};

/// Cuts the periodic box across z, presses the slab between two rigid walls with its width held, and takes off what the
/// uncut bulk gives at the same pressure.
std::vector<SlabState> press_slab(const GrainTemplate& box, double alpha, double largest_pressure);

/// The layer nearest to the states of all slabs (least squares in the overlap).
/// \throws std::runtime_error when no layer with c1 > 0 fits.
FlatSurface fit_surface(const std::vector<SlabState>& states);

} // namespace boba::calibration
