// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/bulk_density.h"
#include "calibration/network/alpha_sweep.h"

#include <CLI/CLI.hpp>
#include <cstdint>

namespace boba::calibration {

/// Options of every command that averages over periodic boxes.
struct BoxOptions {
  double size = 20.0;
  int nodes = 0;
  int seeds = 3;
  std::uint64_t seed = 1;
  double density = bulk_node_density;
  double bond_cutoff = 1.5;
  double tolerance = 1e-5;

  void add_to(CLI::App& app);
  /// \throws std::invalid_argument for values outside their range.
  SweepSettings settings(std::vector<double> alphas) const;
};

} // namespace boba::calibration
