// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "bpm/grain/linear_network.h"
#include "bpm/laws/material.h"
#include "bpm/packing/packing.h"

#include <optional>

namespace boba {

/// Largest time step at which a free grain near its undeformed state is stable in the leapfrog scheme (tau).
///
/// With stiffness A and damping C of the linearised bond network (over m) the scheme x' = x + dt v', v' = v - dt (A x +
/// C v) leaves the stable region where one of its factors is -1: where 2 dt C + dt^2 A has the eigenvalue 4. Power
/// iteration on that operator, dt following the vector's Rayleigh quotients, finds the smallest such dt. Contacts are
/// not in it (docs/stability.md says what they cost), nor is the slow growth that the many-body term, which has no
/// energy, gives to grains without damping.
/// \throws std::invalid_argument for a template without bonds.
/// Source: roots of z^2 - (2 - dt^2 w^2 - c dt) z + (1 - c dt) on the unit circle; docs/notation.md, "Forces", "Time".
double stable_step(const GrainTemplate& grain, const Material& material, double alpha);
/// The same for a network linearised under any bond law.
double stable_step(const LinearNetwork& network, double node_mass, double alpha);

/// A time step and the many-body coefficient of the grains that it belongs to.
struct PackingStep {
  double dt = 0.0;    ///< tau
  double alpha = 0.0; ///< k d
};

/// The smallest stable step of a packing's grains: of each template with its smallest and its largest alpha. Nothing
/// when no grain has bonds. Of more than eight templates the first eight are looked at.
std::optional<PackingStep> stable_step(const Packing& packing, const Material& material);

} // namespace boba
