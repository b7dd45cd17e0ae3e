// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/app/box_options.h"

#include <cstdio>
#include <fmt/format.h>

namespace boba::calibration {

void BoxOptions::add_to(CLI::App& app) {
  auto* length = app.add_option("--size", size, "Side of the periodic box, d")->capture_default_str();
  app.add_option("--nodes", nodes, "Number of nodes of the box, instead of its side")->excludes(length);
  app.add_option("--seeds", seeds, "Number of boxes")->capture_default_str();
  app.add_option("--seed", seed, "Seed of the first box")->capture_default_str();
  app.add_option("--density", density, "Nodes per d^3")->capture_default_str();
  app.add_option("--bond-cutoff", bond_cutoff, "Pairs closer than this are bonded, d")->capture_default_str();
  app.add_option("--tolerance", tolerance, "Relative residual of the solves")->capture_default_str();
}

SweepSettings BoxOptions::settings(std::vector<double> alphas) const {
  SweepSettings settings;
  settings.box.size.setConstant(nodes > 0 ? 1.0 : size);
  if (nodes != 0) {
    settings.box.n_nodes = nodes;
  }
  settings.box.seed = seed;
  settings.box.density = density;
  settings.box.bond_cutoff = bond_cutoff;
  settings.n_seeds = seeds;
  settings.alphas = std::move(alphas);
  if (!(tolerance > 0.0 && tolerance < 0.1)) {
    throw std::invalid_argument(fmt::format("tolerance = {} is outside the allowed 0 .. 0.1", tolerance));
  }
  settings.solve.relative_tolerance = tolerance;
  settings.log = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
  validate(settings.box);
  return settings;
}

} // namespace boba::calibration
