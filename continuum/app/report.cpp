// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/app/report.h"

#include "continuum/app/summary.h"
#include "continuum/elasticity/field_output.h"

#include <algorithm>
#include <fmt/format.h>

namespace boba::continuum {
namespace {

using nlohmann::json;

std::vector<StressPoint> stress_of(const MeridianBody& body, const Material& material,
                                   const std::shared_ptr<const GradientLaw>& law, const Eigen::VectorXd& u) {
  return law ? body.stress(*law, u) : body.stress(material, u);
}

void write_load(const std::filesystem::path& folder, std::size_t i, double value, const MeridianBody& body,
                const Eigen::VectorXd& u, const std::vector<StressPoint>& stress,
                std::vector<std::pair<double, std::string>>& entries) {
  const std::string name = fmt::format("fields_{:04d}.vtu", i);
  write_vtu(folder / name, body, u, stress);
  entries.emplace_back(value, name);
}

} // namespace

json profile_of(const std::vector<FieldPoint>& points) {
  json r = json::array(), z = json::array(), u_r = json::array(), u_z = json::array();
  for (const auto& point : points) {
    r.push_back(point.r);
    z.push_back(point.z);
    u_r.push_back(point.u_r);
    u_z.push_back(point.u_z);
  }
  return {{"r", r}, {"z", z}, {"u_r", u_r}, {"u_z", u_z}};
}

json array_of(const Eigen::VectorXd& values) {
  return std::vector<double>(values.data(), values.data() + values.size());
}

json summary_header(const char* problem, json parameters) {
  return {{"schema", "boba-continuum-summary"},
          {"schema_version", summary_schema_version},
          {"problem", problem},
          {"parameters", std::move(parameters)}};
}

json report(const std::vector<SphereLoad>& loads, const SphereProblem& problem, json parameters) {
  json document = summary_header("sphere", std::move(parameters));
  for (const auto& load : loads) {
    document["loads"].push_back(
        {{"approach", load.approach},
         {"force", load.force},
         {"contact_radius", load.contact_radius},
         {"reference_contact_radius", load.reference_contact_radius},
         {"peak_pressure", load.peak_pressure},
         {"central_pressure", load.central_pressure},
         {"equatorial_bulge", load.equatorial_bulge},
         {"hertz_force", load.hertz.force},
         {"hertz_contact_radius", load.hertz.contact_radius},
         {"hertz_peak_pressure", load.hertz.peak_pressure},
         {"tatara_approach",
          2 * tatara_approach(problem.radius, problem.material, load.force, load.reference_contact_radius)},
         {"active_set_iterations", load.active_set_iterations},
         {"newton_iterations", load.newton_iterations},
         {"ellipticity", load.ellipticity},
         {"n_unknowns", load.n_unknowns},
         {"n_contact_unknowns", load.n_contact_unknowns},
         {"seconds", load.seconds},
         {"contact",
          {{"r", array_of(load.r)}, {"pressure", array_of(load.pressure)}, {"overlap", array_of(load.overlap)}}},
         {"profile", profile_of(load.profile)}});
  }
  return document;
}

json report(const CylinderResult& result, const CylinderProblem&, json parameters) {
  json document = summary_header("cylinder", std::move(parameters));
  for (const auto& load : result.loads) {
    document["loads"].push_back({{"strain", load.strain},
                                 {"force", load.force},
                                 {"apparent_modulus", load.apparent_modulus},
                                 {"midheight_poisson", load.midheight_poisson},
                                 {"midheight_poisson_local", load.midheight_poisson_local},
                                 {"newton_iterations", load.newton_iterations},
                                 {"ellipticity", load.ellipticity},
                                 {"n_unknowns", result.body->n_unknowns()},
                                 {"seconds", load.seconds},
                                 {"profile", profile_of(load.profile)}});
  }
  return document;
}

void write_fields(const std::filesystem::path& folder, const std::vector<SphereLoad>& loads,
                  const SphereProblem& problem) {
  std::vector<std::pair<double, std::string>> entries;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const auto& load = loads[i];
    const auto stress = stress_of(*load.body, problem.material, problem.finite_law, load.displacement);
    write_load(folder, i, load.approach, *load.body, load.displacement, stress, entries);
  }
  write_pvd(folder / "fields.pvd", entries);
}

void write_fields(const std::filesystem::path& folder, const CylinderResult& result, const CylinderProblem& problem) {
  std::vector<std::pair<double, std::string>> entries;
  for (std::size_t i = 0; i < result.loads.size(); ++i) {
    const auto& load = result.loads[i];
    const auto stress = stress_of(*result.body, problem.material, problem.finite_law, load.displacement);
    write_load(folder, i, load.strain, *result.body, load.displacement, stress, entries);
  }
  write_pvd(folder / "fields.pvd", entries);
}

} // namespace boba::continuum
