// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/measure/frame_measures.h"
#include "bpm/app/measure/frame_rest.h"
#include "bpm/app/measure/frame_stress.h"
#include "bpm/app/measure/grain_shapes.h"
#include "bpm/archive/archive.h"
#include "bpm/io/table.h"
#include "bpm/measure/measure_plan.h"
#include "bpm/measure/non_affine.h"
#include "bpm/measure/outside_measure.h"
#include "bpm/measure/stress.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace boba {

/// Measures frames and writes what was found into the tables of one folder.
///
/// Tables, columns and units: docs/formats-measure.md. Frames are given in the order of time. With several ranks all
/// have one alike: what takes long they measure together (measure_together), the rest and the tables are rank 0's.
class MeasureTables {
public:
  /// When the tables are opened: with_first_frame leaves no trace of a frame that cannot be measured.
  enum class Opening { now, with_first_frame };

  /// \param last_step with FileMode::append: rows after this step are removed, and the tables go on
  /// \param ranks must outlive this
  /// \throws std::runtime_error when a table exists (FileMode::create) or cannot be written.
  MeasureTables(std::filesystem::path folder, const Topology& topology, MeasurePlan plan,
                const UndeformedGrains& undeformed, FileMode mode, std::int64_t last_step = -1,
                const Ranks& ranks = Ranks::alone(), Opening opening = Opening::now);

  /// The tables that a plan's measures write. Source: docs/formats-measure.md.
  static std::vector<MeasureTable> tables_of(const MeasurePlan& plan);

  /// Collective. Positions are needed on every rank when the plan needs_all_ranks, all else on rank 0.
  /// \throws std::invalid_argument for a frame that cannot be measured, std::runtime_error when a table cannot be
  /// written; RankError on all when there are several ranks.
  void add(const Snapshot& snapshot);

  /// Forces evaluated again: used for the stress instead of what the frames hold. Null: what the frames hold. With
  /// several ranks all are given one, and every frame whole.
  void set_frame_stress(std::shared_ptr<FrameStress> stress) { frame_stress_ = std::move(stress); }

  /// The order of frames is that of a copy after a rest. Needed on rank 0 alone.
  void set_frame_rest(std::shared_ptr<const FrameRest> rest) { frame_rest_ = std::move(rest); }

  /// What `motion` remembers of the frames so far, so that a run that goes on continues its tables.
  /// \throws SavedStateError when what is read belongs to another packing.
  void archive_motion(Archive& archive);

  /// What was found, for averages: strain and value of each frame, by the name of the quantity.
  struct Series {
    std::vector<double> strain, value;
  };
  const std::map<std::string, Series>& series() const { return series_; }

private:
  using Row = std::vector<std::optional<double>>;

  /// A frame and what is known of it so far.
  struct Frame {
    const Snapshot& snapshot;
    FrameMeasures found;
    std::vector<measure::Tensor6> grain_stress; ///< times the volume, k d
    std::vector<Vector3> centres;               ///< for order and motion, as are the neighbours
    measure::NeighbourLists neighbours;
  };

  static std::vector<std::string> order_columns();
  static std::vector<std::string> grain_order_columns();
  void open(std::int64_t last_step);
  void write(const std::string& table, const Snapshot& snapshot, const Row& values);
  void note(const std::string& quantity, const Snapshot& snapshot, double value);
  double grain_number(int grain) const;

  void write_frame(Frame& frame);
  void add_stress(const Frame& frame);
  void add_packing_fraction(const Frame& frame);
  void add_shape(const Frame& frame);
  void add_facet_sensitivity(const Frame& frame);
  void add_scattering(const Frame& frame);
  void add_order(const Frame& frame);
  void add_contacts(const Frame& frame);
  void add_motion(const Frame& frame);
  void add_outside(const Frame& frame);
  void find_neighbours(Frame& frame) const;
  measure::NeighbourLists neighbours_of(const Frame& frame, const std::vector<Vector3>& centres) const;
  /// Mean over the grains of what their undeformed template has; unknown when one of them is.
  template <class Known, class Value>
  std::optional<double> undeformed_mean(const std::vector<std::optional<Known>>& known, const Value& value) const {
    double sum = 0.0;
    for (const int index : topology_.template_index) {
      if (!known[index]) {
        return std::nullopt;
      }
      sum += static_cast<double>(value(*known[index]));
    }
    return sum / topology_.n_grains();
  }

  std::filesystem::path folder_;
  const Topology topology_;
  MeasurePlan plan_;
  std::vector<std::unique_ptr<const OutsideMeasure>> outside_; ///< on rank 0
  const Ranks& ranks_;
  std::shared_ptr<FrameStress> frame_stress_;
  std::shared_ptr<const FrameRest> frame_rest_;
  FileMode mode_;
  std::map<std::string, TableWriter> tables_;
  struct WaitingRow {
    std::string table;
    std::int64_t step;
    Row values;
  };
  bool is_open_ = false;
  std::vector<WaitingRow> waiting_; ///< rows of the first frame, until the tables are opened
  std::map<std::string, Series> series_;

  double nominal_volume_ = 0.0;                                      ///< of all grains, d^3
  std::vector<std::optional<measure::ConvexHull>> undeformed_hulls_; ///< by template index
  std::vector<std::optional<GrainShape>> undeformed_;                ///< by template index

  /// The frame before, for motion.
  struct Past {
    Box box;
    double strain;
    std::vector<Vector3> centres;
    measure::NeighbourLists neighbours;
    measure::NonAffineMotion motion;
  };
  std::optional<Past> past_;
};

} // namespace boba
