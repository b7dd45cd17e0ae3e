// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_cache.h"
#include "calibration/app/box_options.h"
#include "calibration/app/commands.h"
#include "calibration/app/python.h"
#include "calibration/app/report.h"
#include "calibration/fit/foam_fit.h"

#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <nlohmann/json.hpp>

namespace boba::calibration {

namespace {

struct StrainOptions {
  BoxOptions box;
  double alpha = 0.0;
  double largest = 0.2;
  int points = 8;
  int terms = 2;
  bool fit_tension = false;
  std::string output;
  bool force = false;
};

/// +-largest in equal steps, and +-0.001 for the slope at rest.
std::vector<double> strains_of(const StrainOptions& options) {
  if (!(options.largest >= 0.01 && options.largest <= 0.3) || options.points < 2 || options.points > 100) {
    throw std::invalid_argument(fmt::format("strain = {} and points = {}: allowed are 0.01 .. 0.3 and 2 .. 100",
                                            options.largest, options.points));
  }
  std::vector<double> strains;
  for (int n = -options.points; n <= options.points; ++n) {
    strains.push_back(n == 0 ? -1e-3 : options.largest * n / options.points);
    if (n == 0) {
      strains.push_back(1e-3);
    }
  }
  return strains;
}

UniaxialPoint average(const std::vector<std::vector<UniaxialPoint>>& curves, std::size_t n) {
  UniaxialPoint mean = curves.front()[n];
  mean.lateral_stretch = mean.stress = mean.lateral_stress = 0.0;
  for (const auto& curve : curves) {
    mean.lateral_stretch += curve[n].lateral_stretch / curves.size();
    mean.stress += curve[n].stress / curves.size();
    mean.lateral_stress += curve[n].lateral_stress / curves.size();
  }
  return mean;
}

/// Derivative at point n of the parabola through it and its two neighbours (at the ends, its two nearest points).
template <class X, class Y> double slope_at(const std::vector<UniaxialPoint>& points, std::size_t n, X&& x, Y&& y) {
  const std::size_t m = std::clamp<std::size_t>(n, 1, points.size() - 2);
  const double left = x(points[m]) - x(points[m - 1]), right = x(points[m + 1]) - x(points[m]);
  const double before = (y(points[m]) - y(points[m - 1])) / left, after = (y(points[m + 1]) - y(points[m])) / right;
  const double curvature = (after - before) / (left + right); // half the second derivative
  return before + curvature * left + 2.0 * curvature * (x(points[n]) - x(points[m]));
}

/// E = dP/dl and nu = -d ln(lateral) / d ln(axial).
struct Tangent {
  double young, poisson;
};
Tangent tangent(const std::vector<UniaxialPoint>& points, std::size_t n) {
  return {slope_at(
              points, n, [](const auto& p) { return p.axial_stretch; }, [](const auto& p) { return p.stress; }),
          -slope_at(
              points, n, [](const auto& p) { return std::log(p.axial_stretch); },
              [](const auto& p) { return std::log(p.lateral_stretch); })};
}

std::string curve_csv(const std::vector<UniaxialPoint>& points) {
  std::string text = "strain,stress_k_per_d,lateral_strain,young_k_per_d,poisson\n";
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Tangent slope = tangent(points, n);
    text += fmt::format("{:.6g},{:.8g},{:.8g},{:.6g},{:.6g}\n", points[n].axial_stretch - 1.0, points[n].stress,
                        points[n].lateral_stretch - 1.0, slope.young, slope.poisson);
  }
  return text;
}

/// The compressive half as boba-continuum reads it: compressive strain, compressive stress, lateral strain.
std::string continuum_csv(const std::vector<UniaxialPoint>& points) {
  std::string text = "# compressive strain, compressive nominal stress (k/d), lateral strain\n";
  for (std::size_t n = points.size(); n-- > 0;) {
    if (points[n].axial_stretch < 1.0) {
      text += fmt::format("{:.8g},{:.8g},{:.8g}\n", 1.0 - points[n].axial_stretch, -points[n].stress,
                          points[n].lateral_stretch - 1.0);
    }
  }
  return text;
}

void write_results(const StrainOptions& options, const std::vector<UniaxialPoint>& points, const FoamFit& fit) {
  const std::filesystem::path directory = options.output;
  write_text(directory / "curve.csv", curve_csv(points));
  write_text(directory / "compression.csv", continuum_csv(points));
  nlohmann::json law;
  law["schema"] = "boba-calibration-foam";
  law["version"] = 1;
  law["alpha"] = options.alpha;
  law["axial_residual"] = fit.axial_residual;
  law["lateral_residual"] = fit.lateral_residual;
  for (const continuum::FoamTerm& term : fit.terms) {
    law["foam_terms"].push_back({{"mu", term.shear}, {"alpha", term.exponent}, {"nu", term.poisson}});
  }
  write_text(directory / "foam.json", law.dump(2) + "\n");
  run_python("plot_strain.py", {(directory / "curve.csv").string(), (directory / "curve.png").string()});
}

int strain(const StrainOptions& options) {
  const std::vector<double> strains = strains_of(options);
  const SweepSettings settings = options.box.settings({options.alpha});
  if (!(options.alpha > -1.0 && options.alpha < 1e4)) {
    throw std::invalid_argument(
        fmt::format("alpha = {} k d is at or below the stability limit, about -1.0 k d", options.alpha));
  }
  if (!options.output.empty()) {
    prepare_output(options.output, options.force);
  }
  std::vector<std::vector<UniaxialPoint>> curves;
  for (int s = 0; s < settings.n_seeds; ++s) {
    TemplateSpec spec = settings.box;
    spec.seed += s;
    curves.push_back(uniaxial_curve(TemplateCache().get(spec), options.alpha, strains));
  }
  std::vector<UniaxialPoint> points;
  fmt::print("{:>9} {:>11} {:>11} {:>9} {:>9}\n", "strain", "stress d/k", "lateral", "E d/k", "nu");
  for (std::size_t n = 0; n < strains.size(); ++n) {
    points.push_back(average(curves, n));
  }
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Tangent slope = tangent(points, n);
    fmt::print("{:>9.4f} {:>11.6f} {:>11.6f} {:>9.4f} {:>9.4f}\n", strains[n], points[n].stress,
               points[n].lateral_stretch - 1.0, slope.young, slope.poisson);
  }
  std::vector<UniaxialPoint> fitted;
  std::copy_if(points.begin(), points.end(), std::back_inserter(fitted),
               [&](const UniaxialPoint& point) { return options.fit_tension || point.axial_stretch < 1.0; });
  const FoamFit fit = fit_foam(fitted, options.terms);
  for (const continuum::FoamTerm& term : fit.terms) {
    fmt::print("foam term: mu = {:.6f} k/d, exponent = {:.5f}, nu = {:.5f}\n", term.shear, term.exponent, term.poisson);
  }
  fmt::print("residual: {:.2e} of the largest stress along the axis, {:.2e} across\n", fit.axial_residual,
             fit.lateral_residual);
  if (!options.output.empty()) {
    write_results(options, points, fit);
  }
  return 0;
}

} // namespace

Command add_strain(CLI::App& app) {
  auto options = std::make_shared<StrainOptions>();
  options->box.size = 12.0;
  CLI::App* command = app.add_subcommand("strain", "E and nu against strain, and a hyperelastic law fitted to them");
  command->add_option("--alpha", options->alpha, "Many-body coefficient, k d")->required();
  command->add_option("--strain", options->largest, "Largest strain in compression and tension")->capture_default_str();
  command->add_option("--points", options->points, "Strains on each side")->capture_default_str();
  command->add_option("--terms", options->terms, "Terms of the foam law, 1 or 2")->capture_default_str();
  command->add_flag("--fit-tension", options->fit_tension, "Fit the law to tension too, not to compression alone");
  command->add_option("--output", options->output, "Directory for curve.csv, compression.csv, foam.json and curve.png");
  command->add_flag("--force", options->force, "Write into a directory that holds files");
  options->box.add_to(*command);
  return {command, [options] { return strain(*options); }};
}

} // namespace boba::calibration
