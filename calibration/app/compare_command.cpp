// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/template_cache.h"
#include "bpm/scene/poisson_table.h"
#include "calibration/app/commands.h"
#include "calibration/app/python.h"
#include "calibration/app/report.h"
#include "calibration/compare/comparison.h"

#include <fmt/format.h>
#include <memory>

namespace boba::calibration {

namespace {

struct CompareOptions {
  ComparisonSettings settings;
  std::vector<double> poissons;
  std::string calibration = "fresh", surface = "cut", output;
  std::vector<std::string> presses = {"walls"};
  int bulk_nodes = 4000;
  bool force = false;
};

Press press_from(const std::string& word) {
  return word == "mirror"   ? Press::mirror
         : word == "twin"   ? Press::twin
         : word == "images" ? Press::images
                            : Press::walls;
}

ElasticConstants constants_of(double young, double poisson) {
  return {young / (3.0 * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson))};
}

/// Alphas of the Poisson ratios asked for, by the table; and the table's constants instead of fresh ones if so chosen.
void consult_table(CompareOptions& options) {
  if (options.poissons.empty() && options.calibration == "fresh") {
    return;
  }
  const PoissonTable table = PoissonTable::installed();
  for (const double poisson : options.poissons) {
    options.settings.alphas.push_back(table.alpha_of_poisson(poisson, 1.0));
  }
  if (options.calibration == "table") {
    options.settings.known = [table](double alpha) {
      return std::optional(constants_of(table.young(alpha, 1.0), table.poisson(alpha, 1.0)));
    };
  }
}

void common(CLI::App& command, CompareOptions& options) {
  CLI::Option* alpha =
      command.add_option("--alpha", options.settings.alphas, "Many-body coefficients, k d, separated by commas")
          ->delimiter(',');
  command.add_option("--poisson", options.poissons, "Poisson ratios instead: the table's alphas")
      ->delimiter(',')
      ->excludes(alpha);
  command
      .add_option("--calibration", options.calibration,
                  "fresh: from the bulk itself; table: the installed table's E and nu")
      ->check(CLI::IsMember({"fresh", "table"}))
      ->capture_default_str();
  command.add_option("--bulk-nodes", options.bulk_nodes, "Nodes of the periodic bulk that bodies are cut from")
      ->capture_default_str();
  command
      .add_option("--samples", options.settings.samples, "Bodies, each in a random orientation and place of the bulk")
      ->capture_default_str();
  command.add_option("--seed", options.settings.seed, "Seed of the bulk and of the first body")->capture_default_str();
  command.add_flag("--fields", options.settings.fields, "Compare the fields of the last load too");
  command.add_option("--output", options.output, "Directory for comparison.json, comparison.csv and pictures")
      ->required();
  command.add_flag("--force", options.force, "Write into a directory that holds files");
}

/// Opens the directory, runs one of the two problems, writes and draws.
int run(CompareOptions options, nlohmann::json (*compare)(const ComparisonSettings&)) {
  ComparisonSettings& settings = options.settings;
  settings.surface = surface_from_string(options.surface);
  consult_table(options);
  if (settings.alphas.empty()) {
    throw std::invalid_argument("alpha or poisson: at least one value is needed");
  }
  settings.presses.clear();
  for (const std::string& press : options.presses) {
    settings.presses.push_back(press_from(press));
  }
  prepare_output(options.output, options.force);
  const std::filesystem::path directory = options.output;
  settings.folder = directory / "continuum";
  std::filesystem::create_directories(settings.folder);
  settings.log = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
  settings.templates = [](const TemplateSpec& spec) {
    return TemplateCache().get(spec, [] { fmt::print(stderr, "building a network (kept in the cache)\n"); });
  };
  TemplateSpec bulk{.shape = TemplateSpec::Shape::periodic_box};
  bulk.n_nodes = options.bulk_nodes;
  bulk.seed = settings.seed;
  settings.bulk = settings.templates(bulk);
  const nlohmann::json document = compare(settings);
  fmt::print("{}", comparison_text(document));
  write_text(directory / "comparison.json", document.dump(1) + "\n");
  write_text(directory / "comparison.csv", comparison_csv(document));
  run_python("plot_compare.py", {directory.string()});
  if (settings.fields) {
    run_python("compare_fields.py", {directory.string()});
  }
  return 0;
}

} // namespace

Command add_compare(CLI::App& app) {
  auto cylinder = std::make_shared<CompareOptions>(), sphere = std::make_shared<CompareOptions>();
  cylinder->settings.loads = {0.001, 0.01, 0.05, 0.1, 0.15, 0.2};
  cylinder->settings.samples = 3;
  sphere->settings.loads = {0.005, 0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2, 0.25, 0.3};
  CLI::App* command =
      app.add_subcommand("compare", "Particles against the continuum: a cylinder or a sphere")->require_subcommand(1);
  CLI::App* cylinders = command->add_subcommand("cylinder", "Cylinders squeezed between held and between sliding ends");
  common(*cylinders, *cylinder);
  cylinders->add_option("--radius", cylinder->settings.radius, "Radius of the cut, d")->capture_default_str();
  cylinders->add_option("--height", cylinder->settings.height, "Height, with end slabs of 2 d each, d")
      ->capture_default_str();
  cylinders->add_option("--strain", cylinder->settings.loads, "Strains, rising, separated by commas")->delimiter(',');
  CLI::App* spheres =
      command->add_subcommand("sphere", "Spheres pressed between walls, against a grain, against their images");
  common(*spheres, *sphere);
  spheres->add_option("--nodes", sphere->settings.n_nodes, "Nodes of the sphere")->capture_default_str();
  spheres->add_option("--surface", sphere->surface, "cut or wall")
      ->check(CLI::IsMember({"cut", "wall"}))
      ->capture_default_str();
  spheres
      ->add_option("--approach", sphere->settings.loads,
                   "Approaches of one contact over R, rising, separated by commas")
      ->delimiter(',');
  spheres->add_option("--press", sphere->presses, "walls, mirror, twin, images; several separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember({"walls", "mirror", "twin", "images"}));
  spheres->add_option("--models", sphere->settings.models, "Continuum models, separated by commas; all if not given")
      ->delimiter(',')
      ->check(CLI::IsMember({"linear", "linear_springs", "linear_layer", "finite", "finite_layer", "neo_layer"}));
  return {command, [cylinders, cylinder, sphere] {
            return cylinders->parsed() ? run(*cylinder, compare_cylinder) : run(*sphere, compare_sphere);
          }};
}

} // namespace boba::calibration
