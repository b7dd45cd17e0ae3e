// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "continuum/cylinder/cylinder.h"
#include "continuum/octant/octant_body.h"
#include "continuum/sphere/sphere.h"

#include <nlohmann/json.hpp>
#include <string>

namespace boba::continuum {

/// What the command line chose for three dimensions alone.
struct OctantChoice {
  /// Even refinements of the coarse octant.
  unsigned refinements = 2;
  double elements_across = 10;
  Multigrid multigrid = Multigrid::gamg;
  /// Folder for the fields of the last load; empty: none.
  std::string fields;
};

/// Solves the loads on an octant and returns the summary. Small strain and rigid plates only; throws
/// std::invalid_argument for anything else, and what the solvers throw. Collective over all ranks.
nlohmann::json run_octant(const SphereProblem& problem, const OctantChoice& choice, nlohmann::json parameters);
nlohmann::json run_octant(const CylinderProblem& problem, const OctantChoice& choice, nlohmann::json parameters);

} // namespace boba::continuum
