// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/scene_packing.h"

#include "bpm/forces/contact_laws.h"
#include "bpm/grain/template_cache.h"
#include "bpm/io/input_error.h"
#include "bpm/scene/read_sizes.h"
#include "bpm/scene/scene_size.h"

#include <algorithm>
#include <fmt/format.h>

namespace boba {

namespace {

using Templates = std::vector<std::shared_ptr<const GrainTemplate>>;

Templates build_templates(const Scene& scene, const Narrator& narrate) {
  const TemplateCache cache;
  Templates templates;
  for (const SceneTemplate& t : scene.templates) {
    const auto before = [&] {
      const std::filesystem::path file = cache.file_of(t.spec);
      narrate(fmt::format("building the grain template \"{}\" (about {:.0f} nodes){}", t.name, expected_nodes(t.spec),
                          file.has_parent_path() ? "; once, then it is read from " + file.string()
                                                 : "; there is no home folder and no BOBA_CACHE_DIR to keep it in"));
    };
    templates.push_back(std::make_shared<const GrainTemplate>(cache.get(t.spec, before)));
  }
  return templates;
}

std::vector<Grain> grains_of(const Scene& scene, const PoissonTable& table) {
  std::vector<Grain> grains;
  for (std::size_t s = 0; s < scene.species.size(); ++s) {
    const SceneSpecies& species = scene.species[s];
    Grain grain;
    grain.template_index = species.template_index;
    grain.species = static_cast<int>(s);
    grain.breaking = species.breaking;
    grain.breaking.seed = scene.seed;
    grain.yielding = species.yielding;
    try {
      grain.alpha = resolve_alpha(species.material, scene.material, table);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: species.{}: {}", scene.path.string(), s, error.what()));
    }
    if (species.sizes.empty()) {
      grains.insert(grains.end(), static_cast<std::size_t>(species.count), grain);
    }
    for (const GrainsOfSize& size : species.sizes) {
      grain.template_index = size.template_index;
      grains.insert(grains.end(), static_cast<std::size_t>(size.count), grain);
    }
  }
  return grains;
}

/// What only the packing tells, of grains that come from files.
void check_grains(const Scene& scene, const Packing& packing) {
  if (packing.grains.empty()) {
    throw InputError(fmt::format("{}: the packing has no grains", scene.path.string()));
  }
  const std::vector<int> nodes = packing.nodes_of_grains();
  const int fewest = *std::min_element(nodes.begin(), nodes.end()),
            most = *std::max_element(nodes.begin(), nodes.end());
  for (std::size_t i = 0; i < scene.measures.size() && fewest < MeasurePlan::fewest_nodes_of_hull; ++i) {
    if (scene.measures[i].plan.needs_hulls()) {
      throw InputError(
          fmt::format("{}: measure.{}.what looks at the hulls of grains, which need {} nodes and more; the "
                      "packing has grains of {}",
                      scene.path.string(), i, MeasurePlan::fewest_nodes_of_hull, fewest));
    }
  }
  if (contact_law_of(scene.material).for_spheres && most > 1) {
    throw InputError(
        fmt::format("{}: material.contact = \"{}\" is for spheres of one node; the packing has grains of {}",
                    scene.path.string(), scene.material.contact, most));
  }
}

} // namespace

double resolve_alpha(const AlphaChoice& choice, const Material& material, const PoissonTable& table) {
  const double alpha =
      choice.poisson ? table.alpha_of_poisson(*choice.poisson, material.k) : choice.alpha.value_or(0.0);
  const std::optional<double> limit = table.stability_limit(material.k);
  if (limit && alpha <= *limit) {
    throw InputError(fmt::format(
        "alpha = {:g}: the bonded network is not stable at and below {:g} k d; allowed: above that", alpha, *limit));
  }
  return alpha;
}

Packing make_start(const Scene& scene, const PoissonTable& table, const Narrator& narrate) {
  check_memory(scene);
  StartContext context;
  context.grains = grains_of(scene, table);
  context.templates = build_templates(scene, narrate);
  for (const SceneSpecies& species : scene.species) {
    if (!species.sizes.empty()) {
      narrate(fmt::format("species \"{}\": {}", species.name, realised_sizes(species, context.templates)));
    }
  }
  context.material = scene.material;
  context.seed = scene.seed;
  context.alpha = [&](const AlphaChoice& choice) { return resolve_alpha(choice, scene.material, table); };
  context.narrate = narrate;
  Packing packing = scene.start->make(context);
  check_grains(scene, packing);
  return packing;
}

std::optional<PackingStep> settle_time_step(Scene& scene, const Packing& packing) {
  const std::optional<PackingStep> stable = stable_step(packing, scene.material);
  if (scene.automatic_dt) {
    if (stable) {
      scene.options.dt = automatic_share * stable->dt;
    }
    scene.automatic_dt = false;
    scene.overrides.push_back(fmt::format("run.dt={}", scene.options.dt));
  }
  return stable;
}

void check_time_step(const Scene& scene, const std::optional<PackingStep>& stable) {
  if (stable && !(scene.options.dt < stable->dt)) {
    throw InputError(
        fmt::format("{}: run.dt = {:g} tau: the bonds of grains with alpha = {:g} are stable only below {:.4g} tau; "
                    "run.dt = \"auto\" takes {:.4g}",
                    scene.path.string(), scene.options.dt, stable->alpha, stable->dt, automatic_share * stable->dt));
  }
}

std::optional<double> effective_modulus(const Packing& packing, const Material& material, const PoissonTable& table) {
  if (const auto modulus = contact_model(material)->effective_modulus()) {
    return modulus;
  }
  double sum = 0.0, nodes = 0.0;
  for (int g = 0; g < packing.n_grains(); ++g) {
    const std::optional<double> modulus = table.effective_modulus(packing.grains[g].alpha, material.k);
    if (!modulus) {
      return std::nullopt;
    }
    sum += *modulus * packing.template_of(g).n_nodes();
    nodes += packing.template_of(g).n_nodes();
  }
  return nodes > 0.0 ? std::optional(sum / nodes) : std::nullopt;
}

} // namespace boba
