// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/linear_solve.h"

#include <algorithm>
#include <fmt/format.h>

namespace boba::calibration {

std::string residual_history_end(KSP solver) {
  const PetscReal* history = nullptr;
  PetscInt length = 0;
  check(KSPGetResidualHistory(solver, &history, &length), "KSPGetResidualHistory");
  std::string text;
  for (PetscInt n = std::max<PetscInt>(0, length - 5); n < length; ++n) {
    text += fmt::format("{}{:.3e}", text.empty() ? "" : ", ", history[n]);
  }
  return text;
}

int solve_or_throw(KSP solver, Vec right_hand_side, Vec solution, const std::string& what) {
  check(KSPSolve(solver, right_hand_side, solution), "KSPSolve");
  KSPConvergedReason reason{};
  PetscInt iterations = 0;
  check(KSPGetConvergedReason(solver, &reason), "KSPGetConvergedReason");
  check(KSPGetIterationNumber(solver, &iterations), "KSPGetIterationNumber");
  if (reason <= 0) {
    throw std::runtime_error(
        fmt::format("{}: the linear solve did not converge ({}, {} iterations); last residuals: {}", what,
                    KSPConvergedReasons[reason], iterations, residual_history_end(solver)));
  }
  return static_cast<int>(iterations);
}

} // namespace boba::calibration
