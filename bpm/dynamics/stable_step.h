// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "bpm/laws/material.h"

namespace boba {

/// Largest time step at which a free grain near its undeformed state is stable in the leapfrog scheme (tau).
///
/// For a mode of stiffness w^2 and damping c (both over m) the scheme x' = x + dt v', v' = v - dt (w^2 x + c v) is
/// stable while dt^2 w^2 + 2 dt c <= 4. The largest w^2 and c of the linearised bond network come from power iteration
/// and are taken together, which is on the safe side by the little that their modes differ. Contacts are not in it.
/// \throws std::invalid_argument for a template without bonds.
/// Source: roots of z^2 - (2 - dt^2 w^2 - c dt) z + (1 - c dt) on the unit circle; docs/notation.md, "Forces", "Time".
double stable_step(const GrainTemplate& grain, const Material& material, double alpha);

} // namespace boba
