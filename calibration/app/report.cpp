// SPDX-License-Identifier: GPL-3.0-or-later
#include "calibration/app/report.h"

#include "bpm/grain/template_spec.h"
#include "calibration/app/published.h"
#include "calibration/app/python.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace boba::calibration {

namespace fs = std::filesystem;

namespace {

std::string number(double value, const char* format = "{:.6g}") {
  return std::isnan(value) ? "" : fmt::format(fmt::runtime(format), value);
}

nlohmann::json json_number(double value) {
  return std::isnan(value) ? nlohmann::json() : nlohmann::json(value);
}

nlohmann::json json_of(const SweepRow& row) {
  nlohmann::json entry;
  entry["alpha"] = row.alpha;
  const auto put = [&](const char* name, const Estimate& value) {
    entry[name] = value.mean;
    entry[std::string(name) + "_error"] = json_number(value.error);
  };
  put("young", row.young());
  put("poisson", row.poisson());
  put("bulk", row.bulk());
  put("shear", row.shear());
  entry["anisotropy"] = row.anisotropy;
  entry["asymmetry"] = row.asymmetry;
  entry["iterations"] = row.iterations;
  for (int i = 0; i < 6; ++i) {
    entry["stiffness"].push_back(std::vector<double>(row.stiffness.row(i).begin(), row.stiffness.row(i).end()));
  }
  for (const ElasticConstants& sample : row.samples) {
    entry["samples"].push_back({{"bulk", sample.bulk}, {"shear", sample.shear}});
  }
  if (const auto pair = published_pair(row.alpha)) {
    entry["published"] = {{"young", pair->young}, {"poisson", pair->poisson}};
  }
  return entry;
}

std::vector<const SweepRow*> by_alpha(const Sweep& sweep) {
  std::vector<const SweepRow*> rows;
  for (const SweepRow& row : sweep.rows) {
    rows.push_back(&row);
  }
  std::sort(rows.begin(), rows.end(), [](const SweepRow* a, const SweepRow* b) { return a->alpha < b->alpha; });
  return rows;
}

} // namespace

void prepare_output(const fs::path& directory, bool force) {
  std::error_code error;
  if (fs::exists(directory) && !fs::is_directory(directory)) {
    throw std::invalid_argument(fmt::format("output = {} is a file; name a directory", directory.string()));
  }
  if (fs::is_directory(directory) && !fs::is_empty(directory) && !force) {
    throw std::invalid_argument(
        fmt::format("output = {} exists and holds files; --force writes into it", directory.string()));
  }
  fs::create_directories(directory, error);
  if (error) {
    throw std::invalid_argument(fmt::format("output = {} cannot be made: {}", directory.string(), error.message()));
  }
}

void write_text(const fs::path& file, const std::string& text) {
  const fs::path beside = file.string() + ".part";
  std::ofstream out(beside);
  out << text;
  out.close();
  std::error_code error;
  if (out.good()) {
    fs::rename(beside, file, error);
  }
  if (!out.good() || error) {
    throw std::runtime_error("cannot write " + file.string());
  }
}

std::string table_csv(const Sweep& sweep) {
  std::string text("alpha,young,young_error,poisson,poisson_error,bulk,bulk_error,shear,shear_error,anisotropy,"
                   "published_young,published_poisson\n");
  for (const SweepRow& row : sweep.rows) {
    const Estimate young = row.young(), poisson = row.poisson(), bulk = row.bulk(), shear = row.shear();
    const auto pair = published_pair(row.alpha);
    text += fmt::format("{},{:.8g},{},{:.8g},{},{:.8g},{},{:.8g},{},{:.4g},{},{}\n", row.alpha, young.mean,
                        number(young.error), poisson.mean, number(poisson.error), bulk.mean, number(bulk.error),
                        shear.mean, number(shear.error), row.anisotropy, pair ? number(pair->young) : "",
                        pair ? number(pair->poisson) : "");
  }
  return text;
}

std::string table_json(const Sweep& sweep, const SweepSettings& settings) {
  nlohmann::json document;
  document["schema"] = "boba-calibration-table";
  document["version"] = 1;
  document["units"] = {{"alpha", "k d"}, {"young", "k/d"}, {"bulk", "k/d"}, {"shear", "k/d"}, {"stiffness", "k/d"}};
  document["box"] = canonical_text(settings.box);
  document["seeds"] = settings.n_seeds;
  document["nodes"] = sweep.n_nodes;
  document["relative_tolerance"] = settings.solve.relative_tolerance;
  document["template_seconds"] = sweep.template_seconds;
  document["solve_seconds"] = sweep.solve_seconds;
  if (sweep.stability_limit) {
    document["stability_limit"] = *sweep.stability_limit;
  }
  for (const SweepRow& row : sweep.rows) {
    document["entries"].push_back(json_of(row));
  }
  return document.dump(2) + "\n";
}

std::string table_toml(const Sweep& sweep, const SweepSettings& settings) {
  std::string text = "# Elastic constants of the bonded network against its many-body coefficient, for k = 1: what "
                     "`poisson = ...` in a scene\n"
                     "# reads. alpha in k d, young in k/d. Rows by rising alpha; young must rise, poisson must fall. "
                     "Other keys are ignored.\n"
                     "version = 1\n";
  text += fmt::format(
      "source = \"boba-calibrate make-table: static stiffness of {} periodic networks of {} nodes at {} nodes per d^3, "
      "seeds {} to {}\"\n",
      settings.n_seeds, sweep.n_nodes, settings.box.density, settings.box.seed,
      settings.box.seed + settings.n_seeds - 1);
  if (sweep.stability_limit) {
    text += fmt::format("stability_limit = {:.4f} # alpha below which the undeformed network collapses, k d\n",
                        *sweep.stability_limit);
  }
  for (const SweepRow* row : by_alpha(sweep)) {
    const Estimate young = row->young(), poisson = row->poisson();
    text += fmt::format("\n[[entry]]\nalpha = {}\nyoung = {:.6f}\npoisson = {:.6f}\n", row->alpha, young.mean,
                        poisson.mean);
    if (!std::isnan(young.error)) {
      text += fmt::format("young_error = {:.6f}\npoisson_error = {:.6f}\n", young.error, poisson.error);
    }
  }
  return text;
}

std::string table_text(const Sweep& sweep) {
  std::string text = fmt::format("{:>8} {:>9} {:>8} {:>9} {:>8} {:>10} {:>9} {:>9} {:>9}\n", "alpha", "E d/k", "error",
                                 "nu", "error", "E publ.", "diff.", "nu publ.", "diff.");
  for (const SweepRow& row : sweep.rows) {
    const Estimate young = row.young(), poisson = row.poisson();
    const auto pair = published_pair(row.alpha);
    const auto or_dash = [](const std::string& value) { return value.empty() ? std::string("-") : value; };
    text += fmt::format("{:>8g} {:>9.4f} {:>8} {:>9.4f} {:>8} {:>10} {:>9} {:>9} {:>9}\n", row.alpha, young.mean,
                        or_dash(number(young.error, "{:.4f}")), poisson.mean, or_dash(number(poisson.error, "{:.4f}")),
                        pair ? fmt::format("{:.2f}", pair->young) : "-",
                        pair ? fmt::format("{:+.2f} %", 100.0 * (young.mean / pair->young - 1.0)) : "-",
                        pair ? fmt::format("{:.2f}", pair->poisson) : "-",
                        pair ? fmt::format("{:+.4f}", poisson.mean - pair->poisson) : "-");
  }
  return text;
}

bool plot_table(const fs::path& directory) {
  return run_python("plot_table.py", {(directory / "table.csv").string(), (directory / "table.png").string()});
}

} // namespace boba::calibration
