// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/outside_measure.h"

#include "bpm/measure/measure_plan.h"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>
#include <utility>

namespace boba {

namespace {

std::vector<OutsideMeasureEntry>& entries() {
  static std::vector<OutsideMeasureEntry> added;
  return added;
}

} // namespace

void add_measure(OutsideMeasureEntry entry) {
  const std::vector<std::string> taken = measure_names();
  if (entry.name.empty() || entry.name == "all" || std::ranges::find(taken, entry.name) != taken.end()) {
    throw std::invalid_argument(fmt::format("measure '{}': the name is taken", entry.name));
  }
  entries().push_back(std::move(entry));
}

const std::vector<OutsideMeasureEntry>& outside_measures() {
  return entries();
}

std::vector<std::unique_ptr<const OutsideMeasure>> make_outside_measures(const std::set<std::string>& names) {
  std::vector<std::unique_ptr<const OutsideMeasure>> measures;
  for (const OutsideMeasureEntry& entry : entries()) {
    if (names.contains(entry.name)) {
      measures.push_back(entry.make());
    }
  }
  return measures;
}

} // namespace boba
