// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/archive/archive.h"

#include <cstdint>
#include <string>
#include <vector>

namespace boba {

/// A table that a stage fills beside the run's own: of its cycles, of its steps of strain. It is written when the stage
/// ends (stages/stage-N.csv), and a checkpoint keeps its rows until then.
struct StageTable {
  struct Row {
    std::int64_t step = 0;      ///< of the simulation
    std::vector<double> values; ///< one for each column; not a number where it is not known
  };
  std::vector<std::string> columns; ///< behind the step; each name carries its unit
  std::vector<Row> rows;

  /// The rows; columns belong to the stage.
  void archive(Archive& archive) {
    archive.objects("rows", rows, [](Archive& a, Row& row) {
      a.field("step", row.step);
      a.field("values", row.values);
    });
  }
};

} // namespace boba
