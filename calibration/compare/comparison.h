// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/grain/template_spec.h"
#include "calibration/compare/pressed_sphere.h"
#include "calibration/compare/solid.h"

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace boba::calibration {

/// What to compare, and how finely.
struct ComparisonSettings {
  std::vector<double> alphas;         ///< k d
  GrainTemplate bulk;                 ///< periodic box: calibrated, and bodies are cut from it
  int n_nodes = 5137;                 ///< of a sphere
  double radius = 7.0, height = 18.0; ///< of a cylinder, slabs of 2 d included, d; a longer one buckles sideways
  TemplateSpec::Surface surface = TemplateSpec::Surface::cut;
  int samples = 2; ///< bodies, each in a random orientation (and place of the bulk)
  std::uint64_t seed = 1;
  std::vector<double> loads; ///< approach / R of one contact, or strains; rising
  std::vector<Press> presses = {Press::walls};
  std::vector<std::string> models; ///< of a sphere's continuum (docs/formats-calibration.md); empty: all
  bool fields = false;             ///< write node fields and the continuum's for the last load
  std::filesystem::path folder;    ///< the continuum's results go here
  /// Elastic constants known already (a table); else the bulk is calibrated afresh.
  std::function<std::optional<ElasticConstants>(double alpha)> known;
  std::function<GrainTemplate(const TemplateSpec&)> templates; ///< makes walled grains
  std::function<void(const std::string&)> log;
};

/// Document of schema "boba-comparison" (docs/formats-calibration.md).
/// \throws std::invalid_argument for settings outside their range; std::runtime_error when a solve fails.
nlohmann::json compare_sphere(const ComparisonSettings& settings);
nlohmann::json compare_cylinder(const ComparisonSettings& settings);

/// One line a row and model:
/// alpha,poisson,setup,load,quantity,particles,particles_error,model,continuum,hertz,difference.
std::string comparison_csv(const nlohmann::json& document);
/// The table for the terminal, against the document's own best model.
std::string comparison_text(const nlohmann::json& document);

/// A node's field line: x,y,z, displacement, stress times volume (xx yy zz yz xz xy).
std::string node_fields_csv(const std::vector<Eigen::Vector3d>& reference, const std::vector<Eigen::Vector3d>& position,
                            const std::vector<Eigen::Matrix3d>& virial);

} // namespace boba::calibration
