// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/network/alpha_sweep.h"

#include "bpm/grain/template_cache.h"
#include "calibration/network/stability.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::calibration {

namespace {

/// Every template measured is stable down to about -1.00; above this the eigenvalue solve is spared.
constexpr double certainly_stable = -0.9;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Member> Estimate estimate_of(const std::vector<ElasticConstants>& samples, Member&& member) {
  std::vector<double> values;
  std::transform(samples.begin(), samples.end(), std::back_inserter(values), member);
  return estimate(values);
}

void require_stable(const LinearNetwork& network, Sweep& sweep, double alpha) {
  if (alpha >= certainly_stable) {
    return;
  }
  if (!sweep.stability_limit) {
    sweep.stability_limit = lower_stability_limit(network).alpha;
  }
  if (alpha <= *sweep.stability_limit) {
    throw std::invalid_argument(
        fmt::format("alpha = {} k d is at or below the stability limit of this network, {:.4f} k d", alpha,
                    *sweep.stability_limit));
  }
}

void check_settings(const SweepSettings& settings) {
  if (settings.alphas.empty()) {
    throw std::invalid_argument("alpha: at least one value is needed");
  }
  for (const double alpha : settings.alphas) {
    if (!std::isfinite(alpha) || std::abs(alpha) > 1e4) {
      throw std::invalid_argument(fmt::format("alpha = {} k d is outside the allowed -1 .. 10000", alpha));
    }
  }
  if (settings.n_seeds < 1 || settings.n_seeds > 1000) {
    throw std::invalid_argument(fmt::format("seeds = {} is outside the allowed 1 .. 1000", settings.n_seeds));
  }
}

} // namespace

Estimate SweepRow::young() const {
  return estimate_of(samples, [](const auto& c) { return c.young(); });
}
Estimate SweepRow::poisson() const {
  return estimate_of(samples, [](const auto& c) { return c.poisson(); });
}
Estimate SweepRow::bulk() const {
  return estimate_of(samples, [](const auto& c) { return c.bulk; });
}
Estimate SweepRow::shear() const {
  return estimate_of(samples, [](const auto& c) { return c.shear; });
}

Sweep run_sweep(const SweepSettings& settings) {
  check_settings(settings);
  Sweep sweep;
  for (const double alpha : settings.alphas) {
    sweep.rows.push_back({});
    sweep.rows.back().alpha = alpha;
  }
  const TemplateCache cache;
  for (int s = 0; s < settings.n_seeds; ++s) {
    TemplateSpec spec = settings.box;
    spec.seed += s;
    double start = seconds();
    const GrainTemplate box = cache.get(spec, [&] {
      if (settings.log) {
        settings.log(fmt::format("building the network of seed {} (kept in the cache)", spec.seed));
      }
    });
    sweep.n_nodes = box.n_nodes();
    sweep.template_seconds += seconds() - start;
    start = seconds();
    const LinearNetwork network = connected_network(box);
    if (s == 0) {
      require_stable(network, sweep, *std::min_element(settings.alphas.begin(), settings.alphas.end()));
    }
    const auto solutions = relaxed_stiffness(network, settings.alphas, settings.solve);
    for (std::size_t a = 0; a < solutions.size(); ++a) {
      sweep.rows[a].samples.push_back(isotropic_part(solutions[a].stiffness));
      sweep.rows[a].stiffness += solutions[a].stiffness / settings.n_seeds;
      sweep.rows[a].iterations += solutions[a].iterations;
    }
    sweep.solve_seconds += seconds() - start;
  }
  for (SweepRow& row : sweep.rows) {
    row.anisotropy = anisotropy(row.stiffness);
    row.asymmetry = asymmetry(row.stiffness);
  }
  return sweep;
}

} // namespace boba::calibration
