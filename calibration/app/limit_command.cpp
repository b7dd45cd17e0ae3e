// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_cache.h"
#include "calibration/app/commands.h"
#include "calibration/network/stability.h"

#include <fmt/format.h>
#include <memory>

namespace boba::calibration {

namespace {

struct LimitOptions {
  TemplateSpec spec{.shape = TemplateSpec::Shape::periodic_box};
  std::string shape = "periodic_box", surface = "cut";
  int nodes = 4000;
};

int limit(LimitOptions options) {
  options.spec.shape = shape_from_string(options.shape);
  options.spec.surface = surface_from_string(options.surface);
  options.spec.size.setConstant(1.0);
  options.spec.n_nodes = options.nodes;
  const GrainTemplate grain = TemplateCache().get(options.spec);
  const LinearNetwork network = connected_network(grain);
  require_rigid(network);
  const StabilityLimit lower = lower_stability_limit(network);
  const StabilityLimit upper = upper_stability_limit(network);
  const Vector3& x = network.position()[lower.node];
  fmt::print("alpha > {:.4f} k d: below, the first mode to go takes {:.2g} of the nodes, most of all node {} at "
             "({:.3f}, {:.3f}, {:.3f}) d\n",
             lower.alpha, lower.participation, lower.node, x.x(), x.y(), x.z());
  fmt::print("alpha < {:.4g} k d\naffine shear modulus is zero at {:.4f} k d\n", upper.alpha,
             affine_shear_limit(network));
  return 0;
}

} // namespace

Command add_limit(CLI::App& app) {
  auto options = std::make_shared<LimitOptions>();
  CLI::App* command = app.add_subcommand("limit", "The interval of alpha in which an undeformed network is stable");
  command->add_option("--shape", options->shape, "sphere, cylinder, box or periodic_box")->capture_default_str();
  command->add_option("--surface", options->surface, "cut or wall")->capture_default_str();
  command->add_option("--nodes", options->nodes, "Number of nodes")->capture_default_str();
  command->add_option("--seed", options->spec.seed, "Seed of the network")->capture_default_str();
  return {command, [options] { return limit(*options); }};
}

} // namespace boba::calibration
