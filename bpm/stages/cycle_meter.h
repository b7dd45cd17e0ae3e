// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/dynamics/stage_table.h"
#include "bpm/packing/box.h"

#include <vector>

namespace boba {

/// What a cyclic strain e shows of a packing, cycle by cycle: storage and loss modulus, the energy that a cycle takes,
/// mean pressure and volume, and whether the grains come back.
///
///     G'  = sum (s - <s>) sin / sum e sin,   G'' = sum (s - <s>) cos / sum e sin     over the steps of a cycle
///
/// are those of the first harmonic, with the phase 2 pi (cycles done); s is the stress of the strained component. The
/// energy is the closed integral of s de, per volume, with de = (e(n+1) - e(n-1)) / 2.
class CycleMeter {
public:
  CycleMeter();

  /// One evaluation, in order.
  struct Sample {
    std::int64_t step = 0;
    double cycles = 0.0, next_cycles = 0.0; ///< done until then, and until the next
    double strain = 0.0, strain_before = 0.0, strain_after = 0.0;
    double stress = 0.0, pressure = 0.0, volume = 0.0; ///< k/d, d^3
  };
  /// True when the sample is the last of a cycle: end_cycle must follow.
  bool add(const Sample& sample);
  /// Centres of the grains at the beginning of the first cycle.
  void begin(std::vector<Vector3> centres) { centres_ = std::move(centres); }
  /// \param deformation of the cell since the last sample of the cycle before
  void end_cycle(const Sample& sample, const std::vector<Vector3>& centres, const Matrix3& deformation);

  const StageTable& table() const { return table_; }
  void archive(Archive& archive);

private:
  struct Sums {
    double n = 0.0, stress = 0.0, sine = 0.0, cosine = 0.0, stress_sine = 0.0, stress_cosine = 0.0, strain_sine = 0.0;
    double energy = 0.0, pressure = 0.0, volume = 0.0;
  };
  Sums sums_;
  std::int64_t cycle_ = 0; ///< that is under way, from 0
  std::vector<Vector3> centres_;
  StageTable table_;
};

} // namespace boba
