// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_cache.h"
#include "calibration/app/commands.h"
#include "calibration/network/alpha_sweep.h"
#include "calibration/specimen/cylinder.h"

#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace boba::calibration {

namespace {

struct SpecimenOptions {
  std::vector<double> radii = {5.0, 7.0};
  double aspect = 4.0; // height over radius
  CylinderTest test;
  std::string surface = "cut";
  std::uint64_t seed = 1;
  bool dynamic = false;
};

void print_row(const char* how, double radius, const TemplateSpec& spec, int n_nodes, const CylinderResult& result) {
  fmt::print("{:>8} {:>7g} {:>7g} {:>8} {:>9.4f} {:>9.4f} {:>12.4f} {:>12.4f}\n", how, radius, spec.height, n_nodes,
             result.poisson(), result.young(), result.young_of(M_PI * result.centre_radius * result.centre_radius),
             result.young_of(M_PI * (result.centre_radius + 0.5) * (result.centre_radius + 0.5)));
}

/// The solid the cylinders are held against.
ElasticConstants network_constants(double alpha) {
  SweepSettings settings;
  settings.box.size.setConstant(16.0);
  settings.n_seeds = 1;
  settings.alphas = {alpha};
  return run_sweep(settings).rows.front().samples.front();
}

int specimen(const SpecimenOptions& options) {
  if (!(options.test.alpha > -1.0 && options.test.alpha < 1e4)) {
    throw std::invalid_argument(
        fmt::format("alpha = {} k d is at or below the stability limit, about -1.0 k d", options.test.alpha));
  }
  if (!(options.test.strain > 0.0 && options.test.strain <= 0.05)) {
    throw std::invalid_argument(fmt::format("strain = {} is outside the allowed 0 .. 0.05", options.test.strain));
  }
  const ElasticConstants solid = network_constants(options.test.alpha);
  fmt::print("{:>8} {:>7} {:>7} {:>8} {:>9} {:>9} {:>12} {:>12}\n", "", "R/d", "H/d", "nodes", "nu", "E d/k",
             "E (centres)", "E (+ d/2)");
  std::vector<double> depths;
  for (const double radius : options.radii) {
    TemplateSpec spec{.shape = TemplateSpec::Shape::cylinder, .surface = surface_from_string(options.surface)};
    spec.radius = radius;
    spec.height = options.aspect * spec.radius;
    spec.seed = options.seed;
    const GrainTemplate cylinder =
        TemplateCache().get(spec, [] { fmt::print(stderr, "building a cylinder (kept in the cache)\n"); });
    const CylinderResult result = static_cylinder(cylinder, options.test, spec.density);
    print_row("static", spec.radius, spec, cylinder.n_nodes(), result);
    if (options.dynamic) {
      print_row("dynamic", spec.radius, spec, cylinder.n_nodes(),
                dynamic_cylinder(cylinder, options.test, spec.density));
    }
    depths.push_back(radius * (1.0 - std::sqrt(result.young() / solid.young())));
  }
  const Estimate depth = estimate(depths);
  fmt::print("network: nu = {:.4f}, E = {:.4f} k/d (periodic box of 16 d)\n", solid.poisson(), solid.young());
  fmt::print("E of a cylinder = E (1 - b/R)^2 with b = {:.3f} d: within 3 % for R > {:.0f} d\n", depth.mean,
             std::abs(depth.mean) / (1.0 - std::sqrt(0.97)));
  return 0;
}

} // namespace

Command add_specimen(CLI::App& app) {
  auto options = std::make_shared<SpecimenOptions>();
  CLI::App* command =
      app.add_subcommand("specimen", "E and nu of squeezed particle cylinders, and how they converge with size");
  command->add_option("--alpha", options->test.alpha, "Many-body coefficient, k d")->capture_default_str();
  command->add_option("--radius", options->radii, "Radii, d, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--aspect", options->aspect, "Height over radius")->capture_default_str();
  command->add_option("--strain", options->test.strain, "Shortening over the free height")->capture_default_str();
  command->add_option("--clamp", options->test.clamp_thickness, "Thickness of the held slabs, d")
      ->capture_default_str();
  command->add_option("--surface", options->surface, "cut or wall")->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the network")->capture_default_str();
  command->add_flag("--dynamic", options->dynamic, "Run the engine on each cylinder too");
  return {command, [options] { return specimen(*options); }};
}

} // namespace boba::calibration
