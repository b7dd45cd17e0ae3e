// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/stages/start.h"

namespace boba {

/// [start] with `lammps_reference`: grains from a LAMMPS data file, in the state of a dump file.
class LammpsStart : public StartEntry {
public:
  static SceneSection section();
  LammpsStart(const SceneTable& table, const StartFiles& files);

  void check(const SceneTable&, const SceneGrains&) const override {}
  bool cell_is_open(const SceneGrains&) const override { return false; }
  Packing make(const StartContext& context) const override;
  std::vector<std::filesystem::path> files() const override {
    return state_ ? std::vector{reference_, *state_} : std::vector{reference_};
  }

private:
  std::filesystem::path reference_;
  std::optional<std::filesystem::path> state_;
  int frame_;
  AlphaChoice material_;
  Breaking breaking_;
  Yielding yielding_;
};

} // namespace boba
