// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/stages/cycle_meter.h"

#include <cmath>
#include <numbers>

namespace boba {

CycleMeter::CycleMeter() {
  table_.columns = {"cycle",      "storage_modulus_k/d", "loss_modulus_k/d", "dissipated_energy_k/d",
                    "P_mean_k/d", "volume_mean_d3",      "stress_mean_k/d",  "nonaffine_d"};
}

bool CycleMeter::add(const Sample& sample) {
  const double phase = 2.0 * std::numbers::pi * sample.cycles;
  sums_.n += 1.0;
  sums_.stress += sample.stress;
  sums_.sine += std::sin(phase);
  sums_.cosine += std::cos(phase);
  sums_.stress_sine += sample.stress * std::sin(phase);
  sums_.stress_cosine += sample.stress * std::cos(phase);
  sums_.strain_sine += sample.strain * std::sin(phase);
  sums_.energy += 0.5 * sample.stress * (sample.strain_after - sample.strain_before);
  sums_.pressure += sample.pressure;
  sums_.volume += sample.volume;
  return sample.next_cycles >= static_cast<double>(cycle_ + 1) - 1e-9;
}

void CycleMeter::end_cycle(const Sample& sample, const std::vector<Vector3>& centres, const Matrix3& deformation) {
  // Motion beside the cell's own, and beside that of the whole.
  Vector3 common = Vector3::Zero();
  for (std::size_t g = 0; g < centres.size(); ++g) {
    common += (centres[g] - deformation * centres_[g]) / static_cast<double>(centres.size());
  }
  double square = 0.0;
  for (std::size_t g = 0; g < centres.size(); ++g) {
    square += (centres[g] - deformation * centres_[g] - common).squaredNorm() / static_cast<double>(centres.size());
  }
  const Sums& s = sums_;
  const double mean = s.stress / s.n;
  table_.rows.push_back({sample.step,
                         {static_cast<double>(cycle_ + 1), (s.stress_sine - mean * s.sine) / s.strain_sine,
                          (s.stress_cosine - mean * s.cosine) / s.strain_sine, s.energy, s.pressure / s.n,
                          s.volume / s.n, mean, std::sqrt(square)}});
  sums_ = {};
  centres_ = centres;
  ++cycle_;
}

void CycleMeter::archive(Archive& archive) {
  std::array<double, 10> sums = {sums_.n,           sums_.stress,        sums_.sine,        sums_.cosine,
                                 sums_.stress_sine, sums_.stress_cosine, sums_.strain_sine, sums_.energy,
                                 sums_.pressure,    sums_.volume};
  archive.field("sums", sums);
  sums_ = {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5], sums[6], sums[7], sums[8], sums[9]};
  archive.field("cycle", cycle_);
  archive.field("centres", centres_);
  archive.object("table", table_);
}

} // namespace boba
