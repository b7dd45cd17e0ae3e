// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/app/output_folder.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace boba {

/// Under this name a checkpoint keeps the record below.
inline const std::string output_record_name = "output.files";

/// What a run's files hold when a checkpoint is written, so that a run which continues from it finds gaps.
///
/// Of files that only grow: length and CRC-32 of all their bytes (only what is new is read, each time); of VTK files
/// the same, each alone; of the trajectory its number of frames. The log is left out: nothing is computed from it.
class OutputRecord {
public:
  /// \param names as files_of_run gives them
  OutputRecord(OutputFolder folder, const std::vector<std::string>& names);

  /// A line a file: "LENGTH CRC NAME", or "frames N up to STEP NAME" for the trajectory. All that was written is in the
  /// files; `last_frame` is the step of the trajectory's last one. A frame of the step of the checkpoint may still come
  /// later. \throws std::runtime_error when a file cannot be read.
  std::string text(std::int64_t step, std::int64_t n_frames, std::int64_t last_frame);

private:
  struct Sum {
    std::uint64_t length = 0;
    std::uint32_t crc = 0;
  };
  void extend(const std::string& name);
  /// Files of a folder named by a number up to `last`, each alone.
  void add_numbered(const std::string& folder, std::string_view begin, std::string_view end, std::int64_t last);

  OutputFolder folder_;
  std::vector<std::string> growing_;
  bool has_trajectory_ = false, has_vtk_ = false, has_stage_tables_ = false;
  std::map<std::string, Sum> sums_;
};

/// What a checkpoint's record names and the folder does not hold (any more), a phrase each: file, what is wrong.
std::vector<std::string> missing_output(const OutputFolder& folder, const std::string& record);

} // namespace boba
