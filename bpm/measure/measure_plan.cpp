// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/measure_plan.h"

#include "bpm/measure/outside_measure.h"

#include <array>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>
#include <utility>

namespace boba {

namespace {

constexpr std::array<std::pair<const char*, MeasureKind>, 7> kinds = {{
    {"stress", MeasureKind::stress},
    {"packing-fraction", MeasureKind::packing_fraction},
    {"shape", MeasureKind::shape},
    {"scattering", MeasureKind::scattering},
    {"order", MeasureKind::order},
    {"contacts", MeasureKind::contacts},
    {"motion", MeasureKind::motion},
}};

} // namespace

std::vector<std::string> measure_names() {
  std::vector<std::string> names;
  for (const auto& [name, kind] : kinds) {
    names.emplace_back(name);
  }
  for (const OutsideMeasureEntry& entry : outside_measures()) {
    names.push_back(entry.name);
  }
  return names;
}

void choose_measures(MeasurePlan& plan, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    bool known = name == "all";
    for (const auto& [kind_name, kind] : kinds) {
      if (name == "all" || name == kind_name) {
        plan.kinds.insert(kind);
        known = true;
      }
    }
    for (const OutsideMeasureEntry& entry : outside_measures()) {
      if (name == "all" || name == entry.name) {
        plan.outside.insert(entry.name);
        known = true;
      }
    }
    if (!known) {
      throw std::invalid_argument(
          fmt::format("measure: '{}' is not known; there are all, {}", name, fmt::join(measure_names(), ", ")));
    }
  }
}

} // namespace boba
