// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/app/box_options.h"
#include "calibration/app/commands.h"
#include "calibration/fit/moduli_fit.h"

#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace boba::calibration {

namespace {

const std::vector<double> fit_alphas = {-0.95, -0.85, -0.7, -0.4, 0.0, 0.6, 1.5, 3.0, 5.5, 9.0, 14.0, 22.0, 40.0};

struct FindOptions {
  BoxOptions box;
  double poisson = 0.0;
  double young = 0.0;
};

ModuliFit fit_of(const Sweep& sweep, int sample) {
  std::vector<double> alphas;
  std::vector<ElasticConstants> constants;
  for (const SweepRow& row : sweep.rows) {
    alphas.push_back(row.alpha);
    constants.push_back(sample < 0 ? ElasticConstants{row.bulk().mean, row.shear().mean} : row.samples[sample]);
  }
  return {alphas, constants};
}

int find(const FindOptions& options, bool young_is_given) {
  if (young_is_given && !(options.young > 0.0 && std::isfinite(options.young))) {
    throw std::invalid_argument(fmt::format("young = {} must be positive", options.young));
  }
  if (!(options.poisson > -1.0 && options.poisson < 0.5)) {
    throw std::invalid_argument(
        fmt::format("poisson = {} is outside what any stable solid has, -1 .. 0.5", options.poisson));
  }
  const SweepSettings settings = options.box.settings(fit_alphas);
  const Sweep sweep = run_sweep(settings);
  const ModuliFit mean = fit_of(sweep, -1);
  const double alpha = mean.alpha_of_poisson(options.poisson);
  std::vector<double> alpha_samples, young_samples; // at the same alpha, what the seeds say
  for (int s = 0; s < settings.n_seeds; ++s) {
    const ModuliFit fit = fit_of(sweep, s);
    young_samples.push_back(fit.at(alpha).young());
    const ElasticConstants low = fit.at(fit.highest_alpha()), high = fit.at(fit.lowest_alpha());
    if (options.poisson > low.poisson() && options.poisson < high.poisson()) {
      alpha_samples.push_back(fit.alpha_of_poisson(options.poisson));
    }
  }
  const double young = mean.at(alpha).young();
  const double k = young_is_given ? options.young / young : 1.0;
  const double alpha_error = estimate(alpha_samples).error, young_error = estimate(young_samples).error;
  fmt::print("fit of K(alpha), G(alpha): largest residual {:.1e} in K, {:.1e} in G over alpha = {} .. {} k d\n",
             mean.bulk_residual(), mean.shear_residual(), mean.lowest_alpha(), mean.highest_alpha());
  fmt::print("poisson = {}\nalpha = {:.5f} +- {:.5f} (units of d times the unit of k)\n", options.poisson, k * alpha,
             k * alpha_error);
  fmt::print("k = {:.6f} +- {:.6f}\nyoung = {:.5f} +- {:.5f}\n", k, young_is_given ? k * young_error / young : 0.0,
             k * young, young_is_given ? 0.0 : young_error);
  return 0;
}

} // namespace

Command add_find(CLI::App& app) {
  auto options = std::make_shared<FindOptions>();
  CLI::App* command = app.add_subcommand("find", "The alpha (and k) that give a Poisson ratio (and a Young modulus)");
  command->add_option("--poisson", options->poisson, "Poisson ratio wanted")->required();
  CLI::Option* young = command->add_option("--young", options->young, "Young modulus wanted; k = 1 when left out");
  options->box.add_to(*command);
  return {command, [options, young] { return find(*options, young->count() > 0); }};
}

} // namespace boba::calibration
