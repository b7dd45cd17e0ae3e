// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/compare/comparison_rows.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba::calibration {

using nlohmann::json;

json comparison_head(const char* problem, const ComparisonSettings& settings, const char* best_model) {
  const double most = std::string(problem) == "sphere" ? 0.35 : 0.25;
  if (settings.loads.empty() || !std::is_sorted(settings.loads.begin(), settings.loads.end()) ||
      !(settings.loads.front() > 0.0 && settings.loads.back() <= most)) {
    throw std::invalid_argument(fmt::format("loads of a {} must rise and lie in 0 .. {}", problem, most));
  }
  if (settings.samples < 1 || settings.samples > 1000) {
    throw std::invalid_argument(fmt::format("samples = {} is outside the allowed 1 .. 1000", settings.samples));
  }
  if (settings.n_nodes < 200 || settings.n_nodes > 1000000) {
    throw std::invalid_argument(fmt::format("nodes = {} is outside the allowed 200 .. 1000000", settings.n_nodes));
  }
  for (const double alpha : settings.alphas) {
    if (!(alpha > -1.0 && alpha < 1e4)) {
      throw std::invalid_argument(
          fmt::format("alpha = {} k d is at or below the stability limit, about -1.0 k d", alpha));
    }
  }
  return {{"schema", "boba-comparison"},
          {"version", 1},
          {"problem", problem},
          {"best_model", best_model},
          {"units", {{"length", "d"}, {"force", "k d"}, {"modulus", "k/d"}, {"alpha", "k d"}}},
          {"samples", settings.samples},
          {"rows", json::array()},
          {"cases", json::array()}};
}

Solid solid_of(const ComparisonSettings& settings, double alpha, double largest_strain) {
  if (settings.log) {
    settings.log(fmt::format("alpha = {}: the network as a solid", alpha));
  }
  Solid solid = calibrate_solid(settings.bulk, alpha, settings.folder, std::clamp(largest_strain, 0.03, 0.2));
  if (const auto known = settings.known ? settings.known(alpha) : std::nullopt) {
    solid.constants = *known;
  }
  return solid;
}

json comparison_row(const RowKey& key, const std::vector<double>& samples, const json& continuum, const json& hertz) {
  const Estimate value = estimate(samples);
  json row = {{"alpha", key.solid.alpha},
              {"poisson", key.solid.constants.poisson()},
              {"setup", key.setup},
              {"load", key.load},
              {"quantity", key.quantity},
              {"particles", value.mean},
              {"particles_error", std::isnan(value.error) ? json() : json(value.error)},
              {"samples", samples},
              {"continuum", continuum}};
  if (!hertz.is_null()) {
    row["hertz"] = hertz;
  }
  return row;
}

double interpolated(std::vector<std::pair<double, double>> points, double x) {
  std::sort(points.begin(), points.end());
  const auto above = std::lower_bound(points.begin(), points.end(), std::pair(x, -HUGE_VAL));
  if (above == points.begin()) {
    return points.front().second;
  }
  if (above == points.end()) {
    return points.back().second;
  }
  const auto below = above - 1;
  const double t = (x - below->first) / (above->first - below->first);
  return (1.0 - t) * below->second + t * above->second;
}

std::string comparison_csv(const json& document) {
  std::string text = "alpha,poisson,setup,load,quantity,particles,particles_error,model,continuum,hertz,difference\n";
  const auto number = [](const json& value) {
    return value.is_number() ? fmt::format("{:.8g}", value.get<double>()) : "";
  };
  for (const json& row : document.at("rows")) {
    for (const auto& [model, value] : row.at("continuum").items()) {
      text += fmt::format("{},{},{},{},{},{},{},{},{},{},{:.6g}\n", number(row["alpha"]), number(row["poisson"]),
                          row["setup"].get<std::string>(), number(row["load"]), row["quantity"].get<std::string>(),
                          number(row["particles"]), number(row["particles_error"]), model, number(value),
                          row.contains("hertz") ? number(row["hertz"]) : "",
                          row["particles"].get<double>() - value.get<double>());
    }
  }
  return text;
}

std::string comparison_text(const json& document) {
  const std::string best = document.at("best_model");
  std::string text = fmt::format("{:>6} {:>7} {:>8} {:>6} {:>16} {:>11} {:>9} {:>11} {:>11} {:>9}\n", "alpha", "nu",
                                 "setup", "load", "quantity", "particles", "+-", "continuum", "Hertz", "diff.");
  for (const json& row : document.at("rows")) {
    const json& models = row.at("continuum");
    const bool has = models.contains(best);
    const double particles = row["particles"], continuum = has ? models[best].get<double>() : NAN;
    const std::string difference = !has ? ""
                                   : std::abs(continuum) > 1e-12
                                       ? fmt::format("{:+.1f} %", 100.0 * (particles / continuum - 1.0))
                                       : "";
    text += fmt::format("{:>6g} {:>7.3f} {:>8} {:>6g} {:>16} {:>11.5g} {:>9} {:>11} {:>11} {:>9}\n",
                        row["alpha"].get<double>(), row["poisson"].get<double>(), row["setup"].get<std::string>(),
                        row["load"].get<double>(), row["quantity"].get<std::string>(), particles,
                        row["particles_error"].is_number() ? fmt::format("{:.2g}", row["particles_error"].get<double>())
                                                           : "",
                        has ? fmt::format("{:.5g}", continuum) : "",
                        row.contains("hertz") ? fmt::format("{:.5g}", row["hertz"].get<double>()) : "", difference);
  }
  return text + fmt::format("continuum: {}\n", best);
}

std::string node_fields_csv(const std::vector<Eigen::Vector3d>& reference, const std::vector<Eigen::Vector3d>& position,
                            const std::vector<Eigen::Matrix3d>& virial) {
  std::string text = "x,y,z,ux,uy,uz,wxx,wyy,wzz,wyz,wxz,wxy\n";
  for (std::size_t n = 0; n < reference.size(); ++n) {
    const Eigen::Vector3d &x = reference[n], u = position[n] - x;
    const Eigen::Matrix3d& w = virial[n];
    text += fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", x[0],
                        x[1], x[2], u[0], u[1], u[2], w(0, 0), w(1, 1), w(2, 2), w(1, 2), w(0, 2), w(0, 1));
  }
  return text;
}

} // namespace boba::calibration
