// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/app/summary.h"

#include "base/hdf5/hdf5_file.h"

#include <fmt/format.h>
#include <fstream>
#include <map>
#include <stdexcept>

namespace boba::continuum {
namespace {

using nlohmann::json;

std::ofstream opened(const std::filesystem::path& file) {
  std::ofstream stream(file);
  if (!stream) {
    throw std::runtime_error(fmt::format("cannot write {}", file.string()));
  }
  return stream;
}

void write_csv(const std::filesystem::path& file, const json& loads) {
  auto stream = opened(file);
  const char* separator = "";
  for (const auto& [name, value] : loads.at(0).items()) {
    if (value.is_number()) {
      stream << separator << name << " [" << unit_of(name) << "]";
      separator = ",";
    }
  }
  stream << "\n";
  for (const auto& load : loads) {
    separator = "";
    for (const auto& entry : load) {
      if (entry.is_number()) {
        stream << separator << fmt::format("{:.12g}", entry.get<double>());
        separator = ",";
      }
    }
    stream << "\n";
  }
}

void write_array(const hdf5::File& file, const std::string& name, const std::vector<double>& values,
                 const std::string& unit) {
  file.write(name, std::span<const double>(values));
  file.set_attribute(name, "boba_unit", unit);
}

void write_hdf5(const std::filesystem::path& path, const json& document) {
  hdf5::File file = hdf5::File::create(path);
  file.set_attribute("/", "schema", document.at("schema").get<std::string>());
  file.set_attribute("/", "schema_version", fmt::format("{}", document.at("schema_version").get<int>()));
  file.set_attribute("/", "problem", document.at("problem").get<std::string>());
  file.set_attribute("/", "parameters", document.at("parameters").dump());
  file.make_group("/loads");
  const json& loads = document.at("loads");
  for (const auto& [name, value] : loads.at(0).items()) {
    if (value.is_number()) {
      std::vector<double> column;
      for (const auto& load : loads) {
        column.push_back(load.at(name).get<double>());
      }
      write_array(file, fmt::format("/loads/{}", name), column, unit_of(name));
    }
  }
  for (std::size_t i = 0; i < loads.size(); ++i) {
    for (const auto& [group, value] : loads[i].items()) {
      if (value.is_object()) {
        const std::string folder = fmt::format("/load_{:04d}/{}", i, group);
        file.make_group(folder);
        for (const auto& [name, numbers] : value.items()) {
          write_array(file, folder + "/" + name, numbers.get<std::vector<double>>(), unit_of(name));
        }
      }
    }
  }
  file.close();
}

} // namespace

void prepare_folder(const std::filesystem::path& folder, bool force) {
  if (std::filesystem::exists(folder / "summary.json") && !force) {
    throw std::invalid_argument(
        fmt::format("output = {} holds a summary already: choose another folder or add --force", folder.string()));
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error(fmt::format("cannot make the folder {}: {}", folder.string(), error.message()));
  }
}

void write_summary(const std::filesystem::path& folder, const json& document) {
  opened(folder / "summary.json") << document.dump(1) << "\n";
  write_csv(folder / "loads.csv", document.at("loads"));
  write_hdf5(folder / "summary.h5", document);
}

std::string unit_of(const std::string& field) {
  static const std::map<std::string, std::string> units = {{"approach", "length"},
                                                           {"contact_radius", "length"},
                                                           {"hertz_contact_radius", "length"},
                                                           {"equatorial_bulge", "length"},
                                                           {"reference_contact_radius", "length"},
                                                           {"tatara_approach", "length"},
                                                           {"r", "length"},
                                                           {"z", "length"},
                                                           {"u_r", "length"},
                                                           {"u_z", "length"},
                                                           {"overlap", "length"},
                                                           {"force", "stress*length^2"},
                                                           {"hertz_force", "stress*length^2"},
                                                           {"peak_pressure", "stress"},
                                                           {"central_pressure", "stress"},
                                                           {"hertz_peak_pressure", "stress"},
                                                           {"pressure", "stress"},
                                                           {"apparent_modulus", "stress"},
                                                           {"seconds", "s"},
                                                           {"assemble_seconds", "s"},
                                                           {"precondition_seconds", "s"},
                                                           {"solve_seconds", "s"},
                                                           {"assemble_cpu_seconds", "s"},
                                                           {"precondition_cpu_seconds", "s"},
                                                           {"solve_cpu_seconds", "s"}};
  const auto found = units.find(field);
  return found == units.end() ? "1" : found->second;
}

} // namespace boba::continuum
