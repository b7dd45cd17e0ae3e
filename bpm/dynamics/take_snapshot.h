// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/moving_packing.h"

namespace boba {

/// Pressure that rounding of the forces can make up, k/d: what floats or doubles leave of bonds at rest.
double least_pressure(Precision precision);

/// Stress at the present step, as Totals::stress; needs an evaluation with Virial::full. The cost is a sum over grains.
std::array<double, 6> stress_of(const MovingPacking& moving);

/// Sums over the packing at the present step; needs an evaluation with Virial::full. Collective.
Totals totals_of(const MovingPacking& moving);

/// The state of the present step in plain arrays: positions, cell, velocities, forces and stress belong together. (What
/// was decided about the cell at the end of the step is not part of it, except for the strain.) Collective.
/// \throws std::logic_error when velocities or forces are asked for at a step whose full stress nobody asked for: its
/// forces were not kept.
Snapshot take_snapshot(const MovingPacking& moving, Simulation::Parts parts);

} // namespace boba
