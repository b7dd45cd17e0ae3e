// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/octant/octant_shape.h"

#include <deal.II/distributed/tria.h>

namespace boba::continuum {

using OctantMesh = dealii::parallel::distributed::Triangulation<3>;

/// Fills an empty mesh with the octant, refined, its boundaries named (OctantBoundary). Collective.
void make_octant(OctantMesh& mesh, const OctantShape& shape);

} // namespace boba::continuum
