// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/toml/schema.h"

#include <algorithm>
#include <map>
#include <string>

namespace boba::test {

/// A scene that is right, with one line to be tried in the table of a section.
class TrialScene {
public:
  TrialScene(const SceneSection& section, const std::string& key) : section_(section), key_(key) {}

  /// The text with `line` in the table; without it the scene is right unless the key is needed.
  std::string text(const std::string& line) const {
    std::string text = section_.path.empty() ? line + "\n" : "";
    const bool is_specimen = section_.kind == "specimen" || section_.kind == "press";
    if (section_.path == "start") {
      return text + table(line) + "[[stage]]\ntype = \"hold\"\ntime = 1.0\n";
    }
    if (!section_.path.empty() && section_.path != "stage") {
      text += table(line);
    }
    text += "[[template]]\nname = \"t\"\nnodes = 60\n[[species]]\ntemplate = \"t\"\nalpha = 1.0\n";
    text += is_specimen ? "count = 1\n" : "count = 2\n";
    if (section_.kind == "insert" || section_.kind == "specimen") {
      return text + table(line) + "[[stage]]\ntype = \"hold\"\ntime = 1.0\n";
    }
    text += is_specimen ? "[[stage]]\ntype = \"specimen\"\n" : "[[stage]]\ntype = \"insert\"\npacking_fraction = 0.2\n";
    return text + (section_.path == "stage" ? table(line) : "");
  }

  /// Number of the line that is tried.
  static int line_number(const std::string& text, const std::string& line) {
    return 1 + static_cast<int>(
                   std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(line)), '\n'));
  }

private:
  std::string table(const std::string& line) const {
    std::string text = section_.repeated ? "[[" + section_.path + "]]\n" : "[" + section_.path + "]\n";
    if (section_.path == "species.size") { // 64 sizes and more
      text = "[[species]]\ntemplate = \"t\"\nalpha = 2.0\ncount = 100\n" + text;
    }
    if (!section_.kind.empty()) {
      text += "type = \"" + section_.kind + "\"\n";
    }
    text += line + "\n";
    for (const auto& [name, value] : companions()) {
      if (name != key_) {
        text += name + " = " + value + "\n";
      }
    }
    return text;
  }

  /// What the table needs beside the key.
  std::map<std::string, std::string> companions() const {
    const std::string& path = section_.path;
    if (path == "template") {
      std::map<std::string, std::string> needed = {{"name", "\"u\""}};
      if (key_ != "radius") { // a sphere takes one of them
        needed["nodes"] = "60";
      }
      const std::map<std::string, std::string> shape_of_key = {{"height", "\"cylinder\""},
                                                               {"exponent", "\"superellipsoid\""},
                                                               {"exponent_z", "\"superellipsoid\""},
                                                               {"rounding", "\"polyhedron\""}};
      if (const auto shape = shape_of_key.find(key_); shape != shape_of_key.end()) {
        needed["shape"] = shape->second;
      }
      return needed;
    }
    if (path == "species") {
      std::map<std::string, std::string> needed = {{"count", "2"}, {"template", "\"t\""}};
      if (key_ != "poisson") {
        needed["alpha"] = "2.0";
      }
      if (key_ == "yield_hardening") {
        needed["yield_strain"] = "0.1";
      } else if (key_ == "break_scatter") {
        needed["break_strain"] = "0.2";
      }
      return needed;
    }
    if (path == "species.size") {
      std::map<std::string, std::string> needed = {{"distribution", "\"uniform\""}, {"spread", "0.1"}};
      if (key_ == "diameters" || key_ == "shares") {
        needed = {{"distribution", "\"list\""}, {"diameters", "[1.0]"}};
      }
      return needed;
    }
    if (path == "measure") {
      return key_ == "rest_time" ? std::map<std::string, std::string>{{"what", "\"order\""}, {"relaxed", "true"}}
                                 : std::map<std::string, std::string>{{"what", "\"stress\""}};
    }
    if (path != "stage" && path != "start") {
      return {};
    }
    if (path == "start") {
      return key_.starts_with("lammps") ? std::map<std::string, std::string>{{"lammps_reference", "\"a.data\""}}
                                        : std::map<std::string, std::string>{{"trajectory", "\"a.h5\""}};
    }
    const std::map<std::string, std::map<std::string, std::string>> of_stage = {
        {"insert", {{"packing_fraction", "0.2"}}},
        {"compress", {{"pressure", "0.1"}}},
        {"hold", {{"time", "1.0"}, {"pressure", "0.1"}}},
        {"shear", {{"rate", "1e-3"}, {"strain", "0.5"}, {"pressure", "0.1"}}},
        {"press", {{"strain", "0.1"}}},
        {"deform", {{"time", "1.0"}, {key_.starts_with("xx") ? "yy_stress" : "xx_stress", "0.0"}}},
        {"uniaxial", {{"strain", "0.01"}, {"rate", "1e-3"}}},
        {"oedometer", {{"strain", "0.01"}, {"rate", "1e-3"}}},
        {"quasistatic", {{"strain", "0.01"}}},
        {"pure_shear", {{"strain", "0.01"}, {"rate", "1e-3"}}},
        {"triaxial", {{"strain", "0.01"}, {"rate", "1e-3"}, {"confining_pressure", "0.1"}}},
        {"biaxial", {{"strain", "0.01"}, {"rate", "1e-3"}, {"confining_pressure", "0.1"}}}};
    const auto found = of_stage.find(section_.kind);
    auto needed = found == of_stage.end() ? std::map<std::string, std::string>{} : found->second;
    if (key_ == "normalised_pressure") {
      needed.erase("pressure");
    }
    if (section_.kind == "press" && key_ == "clamp_thickness") {
      needed["ends"] = "\"clamps\"";
    }
    if (section_.kind == "relax" && (key_ == "stress_tolerance" || key_ == "gain" || key_ == "rate_cap")) {
      needed["pressure"] = "0.1";
    }
    if (section_.kind == "deform" && key_ == "period") {
      needed.erase("time");
      needed["xy_amplitude"] = "0.1";
      needed.erase("xx_stress");
    }
    const std::string component = key_.substr(0, 2);
    if (key_.ends_with("_amplitude")) {
      needed.erase("time");
      needed["period"] = "1000.0";
    } else if (key_.ends_with("_strain")) {
      needed["time"] = "1e8"; // the rate stays small
    } else if (key_.ends_with("_rate_from")) {
      needed[component + "_rate"] = "0.01";
    } else if (key_.ends_with("_stress_from")) {
      needed[component + "_stress"] = "0.0";
    }
    return needed;
  }

  const SceneSection& section_;
  std::string key_;
};

} // namespace boba::test
