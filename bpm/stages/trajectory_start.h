// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/start.h"

namespace boba {

/// [start] with `trajectory`: a frame of a trajectory that Boba wrote.
class TrajectoryStart : public StartEntry {
public:
  static SceneSection section();
  TrajectoryStart(const SceneTable& table, const StartFiles& files);

  void check(const SceneTable&, const SceneGrains&) const override {}
  bool cell_is_open(const SceneGrains&) const override { return false; }
  Packing make(const StartContext& context) const override;
  std::vector<std::filesystem::path> files() const override { return {file_}; }

private:
  std::filesystem::path file_;
  int frame_;
  AlphaChoice material_;
  std::optional<double> strain_; ///< instead of the frame's
  Breaking breaking_;
  Yielding yielding_;
};

} // namespace boba
