// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/snapshot.h"

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace boba {

/// A table of a measure: NAME.csv and its columns.
struct MeasureTable {
  std::string name;
  std::vector<std::string> columns; ///< with their units, as "volume_d3"
  bool is_averaged = false;         ///< has one row a frame, and its columns are averaged in averages.json
};

/// Writes a row: a table's name and a value for each of its columns; a value that is not known is an empty cell.
using WriteMeasureRow = std::function<void(const std::string& table, const std::vector<std::optional<double>>& values)>;

/// A measure that a program brings of its own, for runs and stored frames alike.
class OutsideMeasure {
public:
  virtual ~OutsideMeasure() = default;
  /// The tables that it writes; the step, the time and the strain come before their columns.
  virtual std::vector<MeasureTable> tables() const = 0;
  /// Measures a frame, on rank 0: positions of all nodes, d; velocities where a run has them. What it finds depends on
  /// this frame alone, so that a continued run writes the same rows.
  /// \throws std::invalid_argument for a frame that cannot be measured.
  virtual void add(const Snapshot& frame, const Topology& topology, const WriteMeasureRow& write) const = 0;
};

/// A measure that scenes and the command line may choose by name.
struct OutsideMeasureEntry {
  std::string name; ///< of `what = "..."`
  std::function<std::unique_ptr<const OutsideMeasure>()> make;
};

/// Adds a measure, before the first scene is read. One thread only.
///
///     boba::add_measure({"nearest", [] { return std::make_unique<const Nearest>(); }});
///
/// \throws std::invalid_argument when the name, or the name of one of its tables, is taken.
void add_measure(OutsideMeasureEntry entry);

/// All measures that were added.
const std::vector<OutsideMeasureEntry>& outside_measures();

/// The measures of these names, in the order in which they were added.
std::vector<std::unique_ptr<const OutsideMeasure>> make_outside_measures(const std::set<std::string>& names);

} // namespace boba
