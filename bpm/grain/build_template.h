// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/grain_template.h"
#include "bpm/grain/template_spec.h"

namespace boba {

/// Builds the nodes and bonds of a template; the same specification gives the same template on one machine.
///
/// Bulk nodes rest in a periodic box at `density`; `cut` keeps those inside the shape about a random point, `wall`
/// relaxes the same number of nodes inside the shape shrunk to 1.15 times the density (1.41 for 1.226; radius 10 has
/// its wall at 9.54). Bonds join all pairs closer than `bond_cutoff`. A choice that leaves a node floating (see
/// floating_part) is dropped and the next random point, or set of velocities, is taken. The volume it stands for is n /
/// density (d^3); a periodic box's is exact.
///
/// \throws std::invalid_argument for a specification that makes no sense; std::runtime_error when no choice of many
/// leaves a rigid grain. Source: Clemmer, Hackney & Grest, sample preparation; densities from docs/notation.md,
/// "Grain".
GrainTemplate build_template(const TemplateSpec& spec);

} // namespace boba
