// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "calibration/network/petsc_handle.h"

#include <string>

namespace boba::calibration {

/// The end of a solver's residual history, for messages.
std::string residual_history_end(KSP solver);

/// Solves and returns the number of iterations.
/// \throws std::runtime_error naming `what`, PETSc's reason and the end of the residual history unless it converged.
int solve_or_throw(KSP solver, Vec right_hand_side, Vec solution, const std::string& what);

} // namespace boba::calibration
