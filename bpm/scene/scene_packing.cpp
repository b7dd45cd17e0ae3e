// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/scene/scene_packing.h"

#include "bpm/grain/template_cache.h"
#include "bpm/io/input_error.h"
#include "bpm/io/lammps_dump.h"
#include "bpm/io/lammps_packing.h"
#include "bpm/packing/insertion.h"
#include "bpm/scene/scene_size.h"
#include "bpm/scene/trajectory_start.h"

#include <fmt/format.h>
#include <type_traits>

namespace boba {

namespace {

using Templates = std::vector<std::shared_ptr<const GrainTemplate>>;

Templates build_templates(const Scene& scene, const Narrator& narrate) {
  const TemplateCache cache;
  Templates templates;
  for (const SceneTemplate& t : scene.templates) {
    const auto before = [&] {
      narrate(fmt::format("building the grain template \"{}\" (about {:.0f} nodes); once, then it is read from {}",
                          t.name, expected_nodes(t.spec), cache.file_of(t.spec).string()));
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
    try {
      grain.alpha = resolve_alpha(species.material, scene.material, table);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: species.{}: {}", scene.path.string(), s, error.what()));
    }
    grains.insert(grains.end(), static_cast<std::size_t>(species.count), grain);
  }
  return grains;
}

Packing place(const Scene& scene, const InsertStart& start, Templates templates, std::vector<Grain> grains) {
  for (const SceneTemplate& t : scene.templates) {
    if (t.spec.shape == TemplateSpec::Shape::periodic_box) {
      throw InputError(
          fmt::format("{}: template \"{}\" is a periodic_box; it has no surface and cannot be inserted. Use a "
                      "\"specimen\" stage",
                      scene.path.string(), t.name));
    }
  }
  Insertion insertion;
  insertion.templates = std::move(templates);
  insertion.grains = std::move(grains);
  insertion.packing_fraction = start.packing_fraction;
  insertion.rotate = start.rotate;
  insertion.seed = scene.seed;
  insertion.diameter = scene.material.diameter;
  return insert_at_random(insertion);
}

Packing place_specimen(const SpecimenStart& start, Templates templates, const std::vector<Grain>& grains) {
  const GrainTemplate& grain = *templates[grains.front().template_index];
  if (grain.period) {
    const Box box(-0.5 * *grain.period, *grain.period);
    return make_packing(box, std::move(templates), {{grains.front(), Vector3::Zero(), Eigen::Quaterniond::Identity()}});
  }
  Vector3 low = grain.position.front(), high = low;
  for (const Vector3& x : grain.position) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  low.array() -= start.margin;
  high.array() += start.margin;
  const Box box(low, high - low, Vector3::Zero(), {false, false, false});
  return make_packing(box, std::move(templates), {{grains.front(), Vector3::Zero(), Eigen::Quaterniond::Identity()}});
}

Packing make_placed(const Scene& scene, const PoissonTable& table, const Narrator& narrate) {
  check_memory(scene);
  std::vector<Grain> grains = grains_of(scene, table);
  Templates templates = build_templates(scene, narrate);
  if (const auto* specimen = std::get_if<SpecimenStart>(&scene.start)) {
    return place_specimen(*specimen, std::move(templates), grains);
  }
  narrate(fmt::format("placing {} grains at random", grains.size()));
  return place(scene, std::get<InsertStart>(scene.start), std::move(templates), std::move(grains));
}

/// Time step of the frame that a scene counts from 0, or from the end; none for the last.
std::optional<std::int64_t> timestep_of(const LammpsStart& start) {
  if (start.frame == -1 || !start.state) {
    return std::nullopt;
  }
  const std::vector<std::int64_t> steps = lammps_dump_timesteps(*start.state);
  const auto n = static_cast<std::int64_t>(steps.size());
  const std::int64_t number = start.frame < 0 ? n + start.frame : start.frame;
  if (number < 0 || number >= n) {
    throw InputError(fmt::format("{}: start.frame = {}: the file has {} frames; allowed: {} to {}",
                                 start.state->string(), start.frame, n, -n, n - 1));
  }
  return steps[static_cast<std::size_t>(number)];
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
  if (const auto* files = std::get_if<LammpsStart>(&scene.start)) {
    narrate("reading " + files->reference.string());
    Packing packing = read_lammps_packing({files->reference, files->state, timestep_of(*files)}).packing;
    for (Grain& grain : packing.grains) {
      grain.alpha = resolve_alpha(files->material, scene.material, table);
    }
    return packing;
  }
  if (const auto* file = std::get_if<TrajectoryStart>(&scene.start)) {
    narrate("reading " + file->file.string());
    const bool given = file->material.alpha || file->material.poisson;
    return read_trajectory_packing(file->file, file->frame,
                                   given ? std::optional(resolve_alpha(file->material, scene.material, table))
                                         : std::nullopt);
  }
  return make_placed(scene, table, narrate);
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
  if (material.hertz_modulus > 0.0) {
    return material.hertz_modulus;
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

std::vector<SceneStage> resolve_pressures(const Scene& scene, std::optional<double> modulus) {
  std::vector<SceneStage> stages = scene.stages;
  for (SceneStage& stage : stages) {
    if (!stage.normalised_pressure) {
      continue;
    }
    if (!modulus) {
      throw InputError(
          fmt::format("{}: stage.{}.normalised_pressure = {:g}: E and nu are unknown, because an alpha of the "
                      "packing lies outside the installed table; give pressure (k/d) instead",
                      scene.path.string(), stage.index, *stage.normalised_pressure));
    }
    const double pressure = *stage.normalised_pressure * *modulus;
    std::visit(
        [pressure](auto& s) {
          using S = std::decay_t<decltype(s)>;
          if constexpr (std::is_same_v<S, CompressStage>) {
            s.barostat.pressure = pressure;
          } else if constexpr (std::is_same_v<S, HoldStage> || std::is_same_v<S, ShearStage>) {
            s.barostat->pressure = pressure;
          }
        },
        stage.stage);
  }
  return stages;
}

} // namespace boba
