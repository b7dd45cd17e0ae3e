// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/bulk_density.h"
#include "bpm/grain/grain_template.h"
#include "bpm/grain/template_spec.h"

#include <Eigen/Core>
#include <cstdint>

namespace boba::calibration {

/// What a bulk holds per volume: the measures by which the size of a body cut from it is told.
struct BulkDensity {
  double nodes = bulk_node_density; ///< d^-3
  double bonds = 0.0;               ///< sum of r0^2 over bonds per volume, d^-1: the affine bulk modulus is k / 9 of it
};

/// Of a periodic box. \throws std::invalid_argument for a template without a period.
BulkDensity bulk_density(const GrainTemplate& box);

/// A body (shape and size of `spec`, which is not built itself) cut out of the endlessly repeated periodic box, at a
/// place and in an orientation drawn with `sample`.
///
/// Nodes that the cut leaves without a firm hold (fewer than four bonds, or bonds in nearly one plane) are taken off,
/// since a body of many nodes nearly always has one. Costs nothing beside relaxing a bulk of the body's own size.
/// \throws std::invalid_argument for a template without a period; std::runtime_error when nothing firm is left.
GrainTemplate cut_from_bulk(const GrainTemplate& box, const TemplateSpec& spec, std::uint64_t sample);

} // namespace boba::calibration
