// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/averages_file.h"

#include "bpm/io/input_error.h"
#include "bpm/io/output_file.h"
#include "bpm/measure/blocking.h"

#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

namespace boba {

namespace {

/// What this class writes: an object whose members have a mean and its error. (Version 0.1 had one window for all.)
bool is_own(const nlohmann::json& json) {
  if (!json.is_object()) {
    return false;
  }
  for (const auto& [name, value] : json.items()) {
    if (name != "strain_window" && !(value.is_object() && value.contains("mean") && value.contains("standard_error"))) {
      return false;
    }
  }
  return true;
}

} // namespace

struct AveragesFile::Impl {
  nlohmann::json json = nlohmann::json::object();
};

AveragesFile::AveragesFile(std::filesystem::path path) : path_(std::move(path)), impl_(std::make_unique<Impl>()) {
  std::ifstream in(path_);
  if (!in) {
    return;
  }
  impl_->json = nlohmann::json::parse(in, nullptr, false);
  if (!is_own(impl_->json)) {
    throw InputError(
        fmt::format("measure: {} was not written by boba measure and is left alone; --output names another "
                    "folder",
                    path_.string()));
  }
  if (const auto window = impl_->json.find("strain_window"); window != impl_->json.end()) {
    const nlohmann::json of_all = *window;
    impl_->json.erase("strain_window");
    for (auto& value : impl_->json) {
      value["strain_window"] = of_all;
    }
  }
}

AveragesFile::~AveragesFile() = default;
AveragesFile::AveragesFile(AveragesFile&&) noexcept = default;
AveragesFile& AveragesFile::operator=(AveragesFile&&) noexcept = default;

std::string AveragesFile::write(const std::map<std::string, MeasureTables::Series>& series,
                                const std::optional<std::array<double, 2>>& window) {
  std::string lines;
  for (const auto& [name, of_name] : series) {
    impl_->json.erase(name);
    std::vector<double> values;
    for (std::size_t i = 0; i < of_name.value.size(); ++i) {
      if (!window || (of_name.strain[i] > (*window)[0] && of_name.strain[i] < (*window)[1])) {
        values.push_back(of_name.value[i]);
      }
    }
    if (values.size() < 2) {
      continue;
    }
    const measure::BlockedMean mean = measure::blocked_mean(values);
    nlohmann::json& entry = impl_->json[name];
    entry = {{"mean", mean.mean},
             {"standard_error", mean.standard_error},
             {"values", mean.n_values},
             {"block_size", mean.block_size},
             {"reached_plateau", mean.reached_plateau}};
    if (window) {
      entry["strain_window"] = *window;
    }
    lines += fmt::format("{:20s} {:.6g} +- {:.2g} ({} frames{})\n", name, mean.mean, mean.standard_error, mean.n_values,
                         mean.reached_plateau ? "" : "; too few to know the error well");
  }
  if (!impl_->json.empty()) {
    const std::filesystem::path beside = path_.string() + ".part";
    OutputFile file(beside, FileMode::overwrite);
    file.write(impl_->json.dump(2) + "\n");
    file.close();
    std::filesystem::rename(beside, path_);
  }
  return lines;
}

} // namespace boba
