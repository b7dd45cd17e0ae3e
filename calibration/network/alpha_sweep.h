// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/template_spec.h"
#include "calibration/network/elastic_constants.h"
#include "calibration/network/network_stiffness.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace boba::calibration {

/// Which boxes to average over, and at which alphas (k d, for k = 1).
struct SweepSettings {
  TemplateSpec box = {.shape = TemplateSpec::Shape::periodic_box};
  int n_seeds = 3; ///< seeds box.seed, box.seed + 1, ...
  std::vector<double> alphas;
  SolveSettings solve;
  std::function<void(const std::string&)> log; ///< told what takes long
};

/// The elastic constants at one alpha, k = 1: one sample a seed.
struct SweepRow {
  double alpha = 0.0;
  std::vector<ElasticConstants> samples;
  double anisotropy = 0.0;                 ///< of the mean stiffness
  double asymmetry = 0.0;                  ///< of the mean stiffness
  Stiffness stiffness = Stiffness::Zero(); ///< mean over seeds, k/d
  int iterations = 0;

  Estimate young() const;
  Estimate poisson() const;
  Estimate bulk() const;
  Estimate shear() const;
};

struct Sweep {
  std::vector<SweepRow> rows;    ///< in the order of the alphas
  int n_nodes = 0;               ///< of one box
  double template_seconds = 0.0; ///< building or reading the boxes
  double solve_seconds = 0.0;
  std::optional<double> stability_limit; ///< lower limit of alpha, when it was computed
};

/// Runs the sweep. Alphas below -0.9 are held against the exact stability limit of the first box.
/// \throws std::invalid_argument for an alpha at or below the stability limit, or a network that is not rigid;
/// std::runtime_error when a solve does not converge.
Sweep run_sweep(const SweepSettings& settings);

} // namespace boba::calibration
