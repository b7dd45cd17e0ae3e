// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/compare/comparison_rows.h"
#include "calibration/compare/continuum_program.h"
#include "calibration/compare/flat_surface.h"
#include "calibration/specimen/bulk_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>

namespace boba::calibration {

namespace {

using nlohmann::json;

constexpr double slab_pressure = 0.1; // of E / (1 - nu^2): the mean pressure of a contact at approach / R = 0.1

const char* word(Press press) {
  switch (press) {
  case Press::walls:
    return "walls";
  case Press::mirror:
    return "mirror";
  case Press::twin:
    return "twin";
  case Press::images:
    return "images";
  }
  return "";
}

/// The surface that the continuum gets, by rule, and the plain one of node springs for comparison.
struct Surface {
  double body = 0.0;         ///< radius of the solid, by its bonds
  double radius = 0.0;       ///< where plate and layer meet
  double c1 = 0.0, c3 = 0.0; ///< the layer between them
  SurfaceRule springs;       ///< the simple picture: one spring a node of the outermost layer
  json report;
};

/// Grains of one resolution: all samples.
std::vector<GrainTemplate> grains_of(const ComparisonSettings& settings) {
  std::vector<GrainTemplate> grains;
  TemplateSpec spec{.shape = TemplateSpec::Shape::sphere, .surface = settings.surface};
  spec.n_nodes = settings.n_nodes;
  spec.seed = settings.seed;
  for (int s = 0; s < settings.samples; ++s) {
    if (settings.surface == TemplateSpec::Surface::cut) {
      grains.push_back(cut_from_bulk(settings.bulk, spec, settings.seed + s));
    } else { // one walled grain, turned
      GrainTemplate grain = settings.templates(spec);
      const Eigen::Quaterniond turn = Eigen::Quaterniond(Eigen::AngleAxisd(1.3 * s, Eigen::Vector3d::UnitX())) *
                                      Eigen::Quaterniond(Eigen::AngleAxisd(0.7 * s, Eigen::Vector3d::UnitY()));
      for (Eigen::Vector3d& x : grain.position) {
        x = turn * x;
      }
      grains.push_back(std::move(grain));
    }
  }
  return grains;
}

/// Slabs across the three axes of the bulk.
std::vector<std::vector<SlabState>> slabs_of(const ComparisonSettings& settings, const Solid& solid) {
  const double modulus = solid.constants.young() / (1.0 - std::pow(solid.constants.poisson(), 2));
  std::vector<std::vector<SlabState>> slabs;
  for (int axis = 0; axis < 3; ++axis) {
    GrainTemplate box = settings.bulk;
    for (Eigen::Vector3d& x : box.position) {
      x = Eigen::Vector3d(x[axis], x[(axis + 1) % 3], x[(axis + 2) % 3]);
    }
    slabs.push_back(press_slab(box, solid.alpha, slab_pressure * modulus));
  }
  return slabs;
}

/// How the layer's place differs between slabs of the three axes: the standard error of their mean, d.
double place_error(const std::vector<std::vector<SlabState>>& slabs) {
  std::vector<double> places;
  for (const auto& states : slabs) {
    places.push_back(fit_surface(states).beyond);
  }
  return estimate(places).error;
}

/// The solid ends where its bonds end, in the mean of all bodies. The layer on it is, for a cut grain, that of a flat
/// cut through the bulk; for a walled grain its outermost nodes, a spring each.
Surface surface_of(const ComparisonSettings& settings, const Solid& solid, const std::vector<GrainTemplate>& grains) {
  const BulkDensity density = bulk_density(settings.bulk);
  Surface surface{.springs = surface_rule(grains.front(), density.nodes)};
  surface.springs.radius = 0.0;
  for (const GrainTemplate& grain : grains) {
    surface.body += bond_radius(grain, density) / static_cast<double>(grains.size());
    surface.springs.radius += surface_rule(grain, density.nodes).radius / static_cast<double>(grains.size());
  }
  surface.radius = surface.springs.radius;
  surface.c1 = surface.springs.c1;
  surface.c3 = surface.springs.c3;
  surface.report = {{"rule", "layer of node springs"}};
  if (settings.surface == TemplateSpec::Surface::cut) {
    const std::vector<std::vector<SlabState>> slabs = slabs_of(settings, solid);
    std::vector<SlabState> states;
    for (const auto& slab : slabs) {
      states.insert(states.end(), slab.begin(), slab.end());
    }
    const FlatSurface flat = fit_surface(states);
    surface.radius = surface.body + flat.beyond;
    surface.c1 = flat.c1;
    surface.c3 = flat.c3;
    surface.report = {{"rule", "flat cut face"},
                      {"beyond_body", flat.beyond},
                      {"beyond_body_error", place_error(slabs)},
                      {"residual", flat.residual}};
    for (const SlabState& state : states) {
      surface.report["slab"].push_back({{"pressure", state.pressure}, {"beyond_body", state.beyond_body()}});
    }
  }
  surface.report.update({{"body_radius", surface.body},
                         {"radius", surface.radius},
                         {"c1", surface.c1},
                         {"c3", surface.c3},
                         {"springs_radius", surface.springs.radius},
                         {"springs_c1", surface.springs.c1},
                         {"springs_c3", surface.springs.c3},
                         {"nodes_per_area", surface.springs.nodes_per_area}});
  return surface;
}

/// a = sqrt(5/2 <r^2>) weighted by the pressure, as for the particles.
double contact_radius(const json& contact) {
  double force = 0.0, moment = 0.0;
  for (std::size_t n = 1; n < contact["r"].size(); ++n) {
    const double r0 = contact["r"][n - 1], r1 = contact["r"][n], p0 = contact["pressure"][n - 1],
                 p1 = contact["pressure"][n];
    const double r = 0.5 * (r0 + r1), p = 0.5 * (p0 + p1), width = r1 - r0;
    force += p * r * width;
    moment += p * r * r * r * width;
  }
  return force > 0.0 ? std::sqrt(2.5 * moment / force) : 0.0;
}

/// A model of the sphere. `plate`: distance from the centre at which the plate meets the layer. A continuum's layer has
/// no thickness, so its plate is moved in by what the layer stands out.
struct SphereModel {
  const char* name;
  double plate, c1, c3;
  const char* law;
};

/// The loads of one model, a null for each load whose plate does not reach it. Plates are at the same places for every
/// model; a model that reaches less far meets them later.
json run_model(const ComparisonSettings& settings, const Solid& solid, const Surface& surface,
               const SphereModel& sphere) {
  ContinuumModel model{.name = fmt::format("{}_{:g}", sphere.name, solid.alpha),
                       .radius = surface.body,
                       .young = solid.constants.young(),
                       .poisson = solid.constants.poisson(),
                       .c1 = sphere.c1,
                       .c3 = sphere.c3,
                       .law = sphere.law,
                       .compression = solid.compression};
  if (!settings.fields || std::string(sphere.name) != "finite_layer") {
    model.more = {"--no-fields"};
  }
  json all = json::array();
  std::vector<double> approaches;
  for (const double load : settings.loads) {
    const double approach = 2.0 * (sphere.plate - surface.radius * (1.0 - load));
    approach > 0.0 ? approaches.push_back(approach) : all.push_back(nullptr);
  }
  json loads = run_continuum("sphere", model, "approach", approaches, settings.folder);
  for (json& load : loads) {
    load["foam_terms"] = model.law == "foam" ? model.foam_terms : 0;
    all.push_back(load);
  }
  if (model.law == "foam" && loads.size() < approaches.size()) {
    // Two terms may run away beyond the strains they were fitted to; there one term, which fits less well.
    model.foam_terms = 1;
    json simpler = run_continuum("sphere", model, "approach", approaches, settings.folder);
    for (std::size_t l = loads.size(); l < simpler.size(); ++l) {
      simpler[l]["foam_terms"] = 1;
      all.push_back(simpler[l]);
    }
  }
  return all;
}

/// The models: what is changed from one to the next tells the reasons for a difference apart.
json run_models(const ComparisonSettings& settings, const Solid& solid, const Surface& surface) {
  const double layer = surface.radius, c1 = surface.c1, c3 = surface.c3;
  json results;
  for (const SphereModel& model :
       {SphereModel{"linear", layer, 0.0, 0.0, ""},
        SphereModel{"linear_springs", surface.springs.radius, surface.springs.c1, surface.springs.c3, ""},
        SphereModel{"linear_layer", layer, c1, c3, ""}, SphereModel{"finite", layer, 0.0, 0.0, "foam"},
        SphereModel{"finite_layer", layer, c1, c3, "foam"}, SphereModel{"neo_layer", layer, c1, c3, "neo-hookean"}}) {
    if (settings.models.empty() || std::ranges::find(settings.models, model.name) != settings.models.end()) {
      results[model.name] = run_model(settings, solid, surface, model);
    }
  }
  return results;
}

/// A number of each model at one load.
template <class Value> json of_models(const json& models, std::size_t load, Value&& value) {
  json values = json::object();
  for (const auto& [model, loads] : models.items()) {
    if (load < loads.size() && !loads[load].is_null()) {
      values[model] = value(loads[load]);
    }
  }
  return values;
}

/// One number of each load of a model; null where it has none.
json of_loads(const json& loads, const char* name) {
  json values = json::array();
  for (const json& load : loads) {
    values.push_back(load.is_null() ? json() : load.at(name));
  }
  return values;
}

/// Slope of the force from the previous load, both sides alike; none where the law was fitted again between them.
json stiffness_of_models(const json& models, std::size_t load) {
  json values = json::object();
  for (const auto& [model, loads] : models.items()) {
    if (load > 0 && load < loads.size() && !loads[load - 1].is_null() &&
        loads[load]["foam_terms"] == loads[load - 1]["foam_terms"]) {
      values[model] = 2.0 * (loads[load]["force"].get<double>() - loads[load - 1]["force"].get<double>()) /
                      (loads[load]["approach"].get<double>() - loads[load - 1]["approach"].get<double>());
    }
  }
  return values;
}

json profile_report(const std::vector<std::vector<SphereState>>& states, std::size_t load, const json& models) {
  const std::size_t n = states.front()[load].profile.size();
  std::vector<double> angle(n, 0.0), radial(n, 0.0), axial(n, 0.0);
  for (const auto& sample : states) {
    for (std::size_t b = 0; b < n; ++b) {
      angle[b] += sample[load].profile[b].angle / states.size();
      radial[b] += sample[load].profile[b].radial / states.size();
      axial[b] += sample[load].profile[b].axial / states.size();
    }
  }
  json report = {
      {"angle", angle}, {"u_r", radial}, {"u_z", axial}, {"continuum", json::object()}, {"misfit", json::object()}};
  for (const auto& [model, loads] : models.items()) {
    if (load >= loads.size() || loads[load].is_null()) {
      continue;
    }
    const json& profile = loads[load]["profile"];
    std::vector<std::pair<double, double>> by_r, by_z;
    for (std::size_t p = 0; p < profile["r"].size(); ++p) {
      const double at = std::atan2(profile["z"][p].get<double>(), profile["r"][p].get<double>());
      by_r.emplace_back(at, profile["u_r"][p].get<double>());
      by_z.emplace_back(at, profile["u_z"][p].get<double>());
    }
    double sum = 0.0, largest = 0.0;
    std::vector<double> u_r, u_z;
    for (std::size_t b = 0; b < n; ++b) {
      u_r.push_back(interpolated(by_r, angle[b]));
      u_z.push_back(interpolated(by_z, angle[b]));
      sum += (std::pow(radial[b] - u_r[b], 2) + std::pow(axial[b] - u_z[b], 2)) / static_cast<double>(n);
      largest = std::max(largest, std::hypot(u_r[b], u_z[b]));
    }
    report["continuum"][model] = {{"u_r", u_r}, {"u_z", u_z}};
    report["misfit"][model] = std::sqrt(sum) / largest;
  }
  return report;
}

void add_rows(json& document, const Solid& solid, const Surface& surface, Press press,
              const std::vector<std::vector<SphereState>>& states, const std::vector<double>& fractions,
              const json& models) {
  const auto samples = [&](auto&& member) {
    std::vector<double> values;
    for (const auto& sample : states) {
      values.push_back(member(sample));
    }
    return values;
  };
  const double young = solid.constants.young(), modulus = young / (1.0 - std::pow(solid.constants.poisson(), 2));
  json profiles = json::array();
  for (std::size_t l = 0; l < fractions.size(); ++l) {
    const double approach = fractions[l] * surface.radius;
    const double hertz = 4.0 / 3.0 * modulus * std::sqrt(surface.body * approach) * approach;
    const auto row = [&](const char* quantity, const std::vector<double>& values, const json& continuum,
                         const json& reference) {
      document["rows"].push_back(
          comparison_row({solid, word(press), fractions[l], quantity}, values, continuum, reference));
    };
    row("force", samples([&](const auto& s) { return s[l].force; }),
        of_models(models, l, [](const json& load) { return load["force"]; }), hertz);
    if (l > 0) {
      row("stiffness",
          samples([&](const auto& s) { return (s[l].force - s[l - 1].force) / (s[l].approach - s[l - 1].approach); }),
          stiffness_of_models(models, l), 1.5 * hertz / approach);
    }
    if (press == Press::walls) {
      row("contact_radius", samples([&](const auto& s) { return s[l].contact_radius; }),
          of_models(models, l, [](const json& load) { return contact_radius(load["contact"]); }),
          std::sqrt(surface.body * approach));
    }
    row("bulge", samples([&](const auto& s) { return s[l].bulge; }),
        of_models(models, l, [](const json& load) { return load["equatorial_bulge"]; }), nullptr);
    const bool all_touch = std::all_of(states.begin(), states.end(), [&](const auto& s) { return s[l].force > 0.0; });
    if (!all_touch) {
      profiles.push_back({{"load", fractions[l]}});
      continue;
    }
    row("bulge_number", samples([&](const auto& s) { return s[l].bulge * young * surface.body / s[l].force; }),
        of_models(models, l,
                  [&](const json& load) {
                    return load["equatorial_bulge"].get<double>() * young * surface.body / load["force"].get<double>();
                  }),
        nullptr);
    json profile = profile_report(states, l, models);
    profile["load"] = fractions[l];
    profiles.push_back(profile);
  }
  json seconds = json::array(), imbalance = json::array();
  for (const auto& sample : states) {
    double sum = 0.0;
    for (const SphereState& state : sample) {
      sum += state.seconds;
    }
    seconds.push_back(sum);
    imbalance.push_back(sample.back().imbalance);
  }
  double continuum_seconds = 0.0;
  for (const json& load : models.value("finite_layer", json::array())) {
    continuum_seconds += load.is_null() ? 0.0 : load["seconds"].get<double>();
  }
  document["cases"].push_back({{"alpha", solid.alpha},
                               {"poisson", solid.constants.poisson()},
                               {"young", young},
                               {"setup", word(press)},
                               {"nodes", states.front().front().position.size()},
                               {"surface", surface.report},
                               {"seconds", seconds},
                               {"wall_imbalance", imbalance},
                               {"foam_terms", of_loads(models.value("finite_layer", json::array()), "foam_terms")},
                               {"continuum_seconds", continuum_seconds},
                               {"profiles", profiles}});
}

} // namespace

json compare_sphere(const ComparisonSettings& settings) {
  json document = comparison_head("sphere", settings, "finite_layer");
  const std::vector<GrainTemplate> grains = grains_of(settings);
  for (const double alpha : settings.alphas) {
    const Solid solid = solid_of(settings, alpha, 0.2);
    const Surface surface = surface_of(settings, solid, grains);
    SurfaceRule place = surface.springs;
    place.radius = surface.radius;
    place.body = surface.body;
    std::vector<double> approaches;
    for (const double load : settings.loads) {
      approaches.push_back(load * surface.radius);
    }
    const json models = run_models(settings, solid, surface);
    for (const Press press : settings.presses) {
      std::vector<std::vector<SphereState>> states;
      for (const GrainTemplate& grain : grains) {
        if (settings.log) {
          settings.log(
              fmt::format("alpha = {}: sphere {} of {}, {}", alpha, states.size() + 1, grains.size(), word(press)));
        }
        states.push_back(press_sphere(grain, alpha, place, approaches, press));
      }
      if (settings.fields && press == Press::walls) {
        const SphereState& last = states.front().back();
        std::ofstream(settings.folder / fmt::format("nodes_{:g}.csv", alpha))
            << node_fields_csv(grains.front().position, last.position, last.virial);
      }
      add_rows(document, solid, surface, press, states, settings.loads, models);
    }
  }
  return document;
}

} // namespace boba::calibration
