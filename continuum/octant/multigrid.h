// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace boba::continuum {

/// Which algebraic multigrid preconditions the conjugate gradients.
enum class Multigrid {
  /// PETSc's smoothed aggregation, which is told the rigid-body motions.
  gamg,
  /// hypre's BoomerAMG, each displacement component on its own.
  boomer
};

} // namespace boba::continuum
