// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/compare/comparison_rows.h"
#include "calibration/compare/continuum_program.h"
#include "calibration/compare/pressed_cylinder.h"

#include <cmath>
#include <fmt/format.h>
#include <fstream>

namespace boba::calibration {

namespace {

using nlohmann::json;

/// All samples under one kind of ends, and the mean body they stand for.
struct Squeezed {
  CylinderBody body;
  std::vector<double> radii;
  std::vector<std::vector<CylinderState>> states; // [sample][load]
};

Squeezed squeeze_samples(const ComparisonSettings& settings, const BulkDensity& bulk, double alpha, CylinderEnds ends) {
  Squeezed all;
  TemplateSpec spec{.shape = TemplateSpec::Shape::cylinder, .radius = settings.radius, .height = settings.height};
  for (int s = 0; s < settings.samples; ++s) {
    const GrainTemplate cylinder = cut_from_bulk(settings.bulk, spec, settings.seed + s);
    const CylinderPress press(cylinder, bulk);
    all.body.radius += press.body().radius / settings.samples;
    all.body.height += press.body().height / settings.samples;
    all.radii.push_back(press.body().radius);
    all.states.push_back(press.squeeze(alpha, ends, settings.loads));
    if (settings.fields && s == 0 && ends == CylinderEnds::bonded) {
      const CylinderState& last = all.states.back().back();
      std::ofstream(settings.folder / fmt::format("nodes_{:g}.csv", alpha))
          << node_fields_csv(cylinder.position, last.position, last.virial);
    }
  }
  return all;
}

/// Root mean square of the samples' mean profile against the continuum's, over the largest value of the latter.
double profile_misfit(const std::vector<double>& z, const std::vector<double>& u_r, const json& profile) {
  std::vector<std::pair<double, double>> points;
  double largest = 0.0, sum = 0.0;
  for (std::size_t n = 0; n < profile["z"].size(); ++n) {
    points.emplace_back(profile["z"][n].get<double>(), profile["u_r"][n].get<double>());
    largest = std::max(largest, std::abs(points.back().second));
  }
  for (std::size_t b = 0; b < z.size(); ++b) {
    sum += std::pow(u_r[b] - interpolated(points, z[b]), 2);
  }
  return std::sqrt(sum / static_cast<double>(z.size())) / largest;
}

void add_rows(json& document, const Solid& solid, const char* setup, const Squeezed& squeezed, const json& continuum) {
  const auto samples = [&](std::size_t load, auto&& member) {
    std::vector<double> values;
    for (std::size_t s = 0; s < squeezed.states.size(); ++s) {
      values.push_back(member(squeezed.states[s][load], squeezed.radii[s]));
    }
    return values;
  };
  const auto models = [&](std::size_t load, const char* name) {
    json values = json::object();
    for (const auto& [model, loads] : continuum.items()) {
      if (load < loads.size()) {
        values[model] = loads[load][name];
      }
    }
    return values;
  };
  json profiles = json::array();
  for (std::size_t l = 0; l < squeezed.states.front().size(); ++l) {
    const double strain = squeezed.states.front()[l].strain;
    json& rows = document["rows"];
    rows.push_back(comparison_row({solid, setup, strain, "force"},
                                  samples(l, [](const auto& s, double) { return s.force; }), models(l, "force")));
    rows.push_back(
        comparison_row({solid, setup, strain, "apparent_modulus"},
                       samples(l, [](const auto& s, double r) { return s.force / (M_PI * r * r * s.strain); }),
                       models(l, "apparent_modulus")));
    rows.push_back(comparison_row({solid, setup, strain, "poisson"},
                                  samples(l, [](const auto& s, double) { return s.poisson; }),
                                  models(l, "midheight_poisson")));
    // The profile: mean over samples, as error over the largest displacement.
    std::vector<double> z = squeezed.states.front()[l].z, u_r(z.size(), 0.0);
    for (const auto& sample : squeezed.states) {
      for (std::size_t b = 0; b < z.size(); ++b) {
        u_r[b] += sample[l].u_r[b] / static_cast<double>(squeezed.states.size());
      }
    }
    json misfit = json::object(), curves = json::object(), sway = json::array();
    for (const auto& sample : squeezed.states) {
      sway.push_back(sample[l].sway);
    }
    for (const auto& [model, loads] : continuum.items()) {
      if (l < loads.size()) {
        misfit[model] = profile_misfit(z, u_r, loads[l]["profile"]);
        curves[model] = {{"z", loads[l]["profile"]["z"]}, {"u_r", loads[l]["profile"]["u_r"]}};
      }
    }
    profiles.push_back(
        {{"load", strain}, {"z", z}, {"u_r", u_r}, {"sway", sway}, {"misfit", misfit}, {"continuum", curves}});
  }
  document["cases"].push_back({{"alpha", solid.alpha},
                               {"poisson", solid.constants.poisson()},
                               {"young", solid.constants.young()},
                               {"setup", setup},
                               {"radius", squeezed.body.radius},
                               {"height", squeezed.body.height},
                               {"profiles", profiles}});
}

} // namespace

json compare_cylinder(const ComparisonSettings& settings) {
  json document = comparison_head("cylinder", settings, "finite");
  const BulkDensity bulk = bulk_density(settings.bulk);
  for (const double alpha : settings.alphas) {
    const Solid solid = solid_of(settings, alpha, 1.2 * settings.loads.back());
    for (const CylinderEnds ends : {CylinderEnds::bonded, CylinderEnds::sliding}) {
      const char* setup = ends == CylinderEnds::bonded ? "bonded" : "sliding";
      if (settings.log) {
        settings.log(fmt::format("alpha = {}: cylinders with {} ends", alpha, setup));
      }
      const Squeezed squeezed = squeeze_samples(settings, bulk, alpha, ends);
      ContinuumModel model{.name = fmt::format("{}_linear_{:g}", setup, alpha),
                           .radius = squeezed.body.radius,
                           .young = solid.constants.young(),
                           .poisson = solid.constants.poisson(),
                           .compression = solid.compression};
      model.more = {fmt::format("--height={:.10g}", squeezed.body.height), fmt::format("--ends={}", setup)};
      json continuum;
      if (!settings.fields) {
        model.more.emplace_back("--no-fields");
      }
      continuum["linear"] = run_continuum("cylinder", model, "strain", settings.loads, settings.folder);
      model.name = fmt::format("{}_finite_{:g}", setup, alpha);
      model.law = "foam";
      continuum["finite"] = run_continuum("cylinder", model, "strain", settings.loads, settings.folder);
      add_rows(document, solid, setup, squeezed, continuum);
    }
  }
  return document;
}

} // namespace boba::calibration
