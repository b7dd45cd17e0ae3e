// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace boba::calibration {

/// How the continuum program is to model a body: docs/formats-continuum.md has the words.
struct ContinuumModel {
  std::string name; ///< "linear", "finite", ... as tables show it
  double radius = 0.0, young = 0.0, poisson = 0.0;
  double c1 = 0.0, c3 = 0.0;         ///< layer of a compliant interface; c1 = 0: rigid
  std::string law;                   ///< "" for small strain, "foam" (fitted to `compression`) or "neo-hookean"
  std::filesystem::path compression; ///< uniaxial test of the network
  int foam_terms = 2;                ///< of the fit to it
  std::vector<std::string> more;     ///< of one problem: --height, --ends
};

/// Runs boba-continuum (beside this program) for the loads, in a folder of its own below `folder`, and returns its
/// loads.
///
/// Loads are given in rising order. Where the program does not settle, the largest are left out one after another; a
/// load that is missing from the answer was not reached. \throws std::runtime_error when the program is not there or
/// refuses its input.
nlohmann::json run_continuum(const std::string& problem, const ContinuumModel& model, const std::string& load_option,
                             std::vector<double> loads, const std::filesystem::path& folder);

} // namespace boba::calibration
