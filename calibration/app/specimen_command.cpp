// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_cache.h"
#include "calibration/app/box_options.h"
#include "calibration/app/commands.h"
#include "calibration/app/python.h"
#include "calibration/app/report.h"
#include "calibration/network/alpha_sweep.h"
#include "calibration/specimen/bulk_cut.h"
#include "calibration/specimen/cylinder.h"
#include "calibration/specimen/processor_time.h"

#include <cmath>
#include <fmt/format.h>
#include <memory>

namespace boba::calibration {

namespace {

struct SpecimenOptions {
  std::vector<double> radii = {5.0, 7.0};
  double aspect = 4.0; // height over radius
  CylinderTest test;
  std::string surface = "cut", output;
  int bulk_nodes = 9808, samples = 1;
  std::uint64_t seed = 1;
  bool dynamic = false, force = false;
};

TemplateSpec bulk_spec(const SpecimenOptions& options) {
  TemplateSpec spec{.shape = TemplateSpec::Shape::periodic_box, .seed = options.seed};
  spec.n_nodes = options.bulk_nodes;
  return spec;
}

void check_options(const SpecimenOptions& options) {
  if (!(options.test.alpha > -1.0 && options.test.alpha < 1e4)) {
    throw std::invalid_argument(
        fmt::format("alpha = {} k d is at or below the stability limit, about -1.0 k d", options.test.alpha));
  }
  if (!(options.test.strain > 0.0 && options.test.strain <= 0.05)) {
    throw std::invalid_argument(fmt::format("strain = {} is outside the allowed 0 .. 0.05", options.test.strain));
  }
  if (options.samples < 1 || options.samples > 1000) {
    throw std::invalid_argument(fmt::format("samples = {} is outside the allowed 1 .. 1000", options.samples));
  }
}

/// The cylinders of one radius.
struct Row {
  const char* how = "static";
  double radius = 0.0, height = 0.0;
  int n_nodes = 0;
  double seconds = 0.0; // of processor, a sample
  std::vector<CylinderResult> samples;

  template <class Member> Estimate of(Member&& member) const {
    std::vector<double> values;
    for (const CylinderResult& sample : samples) {
      values.push_back(member(sample));
    }
    return estimate(values);
  }
  Estimate poisson() const {
    return of([](const auto& s) { return s.poisson(); });
  }
  Estimate young() const {
    return of([](const auto& s) { return s.young(); });
  }
  Estimate density() const {
    return of([](const auto& s) { return s.young_of(s.density_area); });
  }
  Estimate centres(double beyond) const {
    return of([=](const auto& s) { return s.young_of(M_PI * std::pow(s.centre_radius + beyond, 2)); });
  }
  Estimate bond_radius() const {
    return of([](const auto& s) { return std::sqrt(s.bond_area / M_PI); });
  }
};

void print(const Row& row, const ElasticConstants& solid) {
  const double young = solid.young();
  const auto percent = [&](const Estimate& value) { return 100.0 * (value.mean / young - 1.0); };
  const double error = std::isnan(row.young().error) ? 0.0 : 100.0 * row.young().error / young;
  fmt::print("{:>8} {:>5g} {:>5g} {:>8} {:>8.4f} {:>8.4f} {:>9.3f} {:>+9.2f} {:>5.2f} {:>+9.2f} {:>+9.2f} {:>+9.2f} "
             "{:>8.1f}\n",
             row.how, row.radius, row.height, row.n_nodes, row.poisson().mean, row.young().mean, row.bond_radius().mean,
             percent(row.young()), error, percent(row.density()), percent(row.centres(0.0)), percent(row.centres(0.5)),
             row.seconds);
}

std::string csv(const std::vector<Row>& rows, const ElasticConstants& solid) {
  std::string text("how,radius_d,height_d,nodes,samples,poisson,poisson_error,young,young_error,young_by_density,"
                   "young_by_centres,young_by_centres_plus_half,bond_radius_d,network_poisson,network_young,seconds\n");
  for (const Row& row : rows) {
    const auto error = [](const Estimate& value) {
      return std::isnan(value.error) ? std::string() : fmt::format("{:.4g}", value.error);
    };
    text +=
        fmt::format("{},{},{},{},{},{:.6g},{},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.3g}\n", row.how,
                    row.radius, row.height, row.n_nodes, row.samples.size(), row.poisson().mean, error(row.poisson()),
                    row.young().mean, error(row.young()), row.density().mean, row.centres(0.0).mean,
                    row.centres(0.5).mean, row.bond_radius().mean, solid.poisson(), solid.young(), row.seconds);
  }
  return text;
}

/// The smallest radius from which on E stays within 3 % of the network's; NaN when the largest is not.
double radius_within(const std::vector<Row>& rows, const ElasticConstants& solid) {
  double radius = NAN;
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
    if (std::abs(row->young().mean / solid.young() - 1.0) > 0.03) {
      break;
    }
    radius = row->radius;
  }
  return radius;
}

/// A cut cylinder comes out of the repeated bulk, a walled one is relaxed by itself.
GrainTemplate make_cylinder(const TemplateSpec& spec, const GrainTemplate& bulk) {
  return spec.surface == TemplateSpec::Surface::cut
             ? cut_from_bulk(bulk, spec, spec.seed)
             : TemplateCache().get(spec, [] { fmt::print(stderr, "building a cylinder (kept in the cache)\n"); });
}

int specimen(const SpecimenOptions& options) {
  check_options(options);
  if (!options.output.empty()) {
    prepare_output(options.output, options.force);
  }
  const auto tell = [] { fmt::print(stderr, "building the bulk (kept in the cache)\n"); };
  const GrainTemplate bulk = TemplateCache().get(bulk_spec(options), tell);
  const BulkDensity density = bulk_density(bulk);
  const ElasticConstants solid =
      isotropic_part(relaxed_stiffness(connected_network(bulk), {options.test.alpha}).front().stiffness);
  fmt::print("network: nu = {:.4f}, E = {:.4f} k/d (the bulk of {} nodes); E in % of it, by four areas\n"
             "{:>8} {:>5} {:>5} {:>8} {:>8} {:>8} {:>9} {:>9} {:>5} {:>9} {:>9} {:>9} {:>8}\n",
             solid.poisson(), solid.young(), bulk.n_nodes(), "", "R/d", "H/d", "nodes", "nu", "E d/k", "R_bond/d",
             "by bonds", "+-", "by nodes", "centres", "+ d/2", "CPU s");
  std::vector<Row> rows;
  for (const double radius : options.radii) {
    TemplateSpec spec{.shape = TemplateSpec::Shape::cylinder, .surface = surface_from_string(options.surface)};
    spec.radius = radius;
    spec.height = options.aspect * spec.radius;
    Row rest{.radius = radius, .height = spec.height}, run{.how = "dynamic", .radius = radius, .height = spec.height};
    for (int s = 0; s < options.samples; ++s) {
      spec.seed = options.seed + s;
      const GrainTemplate cylinder = make_cylinder(spec, bulk);
      rest.n_nodes = run.n_nodes = cylinder.n_nodes();
      double start = processor_seconds();
      rest.samples.push_back(static_cylinder(cylinder, options.test, density));
      rest.seconds += (processor_seconds() - start) / options.samples;
      if (options.dynamic) {
        start = processor_seconds();
        run.samples.push_back(dynamic_cylinder(cylinder, options.test, density));
        run.seconds += (processor_seconds() - start) / options.samples;
      }
    }
    print(rest, solid);
    if (options.dynamic) {
      print(run, solid);
    }
    std::fflush(stdout);
    rows.push_back(rest);
  }
  const double radius = radius_within(rows, solid);
  fmt::print("{}\n", std::isnan(radius) ? std::string("the largest cylinder is not within 3 % of the network")
                                        : fmt::format("within 3 % of the network from R = {} d on", radius));
  if (!options.output.empty()) {
    const std::filesystem::path directory = options.output;
    write_text(directory / "specimen.csv", csv(rows, solid));
    run_python("plot_specimen.py", {(directory / "specimen.csv").string(), (directory / "specimen.png").string()});
  }
  return 0;
}

} // namespace

Command add_specimen(CLI::App& app) {
  auto options = std::make_shared<SpecimenOptions>();
  CLI::App* command =
      app.add_subcommand("specimen", "E and nu of squeezed particle cylinders, and how they converge with size");
  command->add_option("--alpha", options->test.alpha, "Many-body coefficient, k d")->capture_default_str();
  command->add_option("--radius", options->radii, "Radii, d, by rising size, separated by commas")
      ->delimiter(',')
      ->capture_default_str();
  command->add_option("--aspect", options->aspect, "Height over radius")->capture_default_str();
  command->add_option("--strain", options->test.strain, "Shortening over the free height")->capture_default_str();
  command->add_option("--clamp", options->test.clamp_thickness, "Thickness of the held slabs, d")
      ->capture_default_str();
  command->add_option("--surface", options->surface, "cut or wall")->capture_default_str();
  command->add_option("--bulk-nodes", options->bulk_nodes, "Nodes of the periodic box that cylinders are cut from")
      ->capture_default_str();
  command->add_option("--samples", options->samples, "Cylinders of each size")->capture_default_str();
  command->add_option("--seed", options->seed, "Seed of the bulk and of the first cylinder")->capture_default_str();
  command->add_option("--output", options->output, "Directory for specimen.csv and specimen.png");
  command->add_flag("--force", options->force, "Write into a directory that holds files");
  command->add_flag("--dynamic", options->dynamic, "Run the engine on each cylinder too");
  return {command, [options] { return specimen(*options); }};
}

} // namespace boba::calibration
