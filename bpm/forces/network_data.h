// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/kernels/kernels.h"
#include "bpm/grain/grain_template.h"

#include <cstdint>
#include <type_traits>
#include <vector>

namespace boba {

/// A bond of a periodic template that joins node i to an image of node j: x_j + h n.
struct ImageBond {
  int i, j;
  Eigen::Vector3i n;
  double r0, inverse_volume;
};

/// A template's bonds as the hot loop wants them, and who is bonded to whom for the contact search.
class NetworkData {
public:
  explicit NetworkData(const GrainTemplate& grain);

  kernels::Network view() const { return {n_nodes_, first_bond_.data(), records_.data(), reach_.data()}; }
  /// The same in the numbers that a kernel computes with, double or float.
  template <class Real> kernels::NetworkOf<Real> view_as() const {
    if constexpr (std::is_same_v<Real, float>) {
      return {n_nodes_, first_bond_.data(), single_records_.data(), reach_.data()};
    } else {
      return view();
    }
  }
  int n_nodes() const { return n_nodes_; }
  std::int64_t n_bonds() const { return static_cast<std::int64_t>(records_.size() + image_bonds_.size()); }
  const std::vector<ImageBond>& image_bonds() const { return image_bonds_; }
  /// True when node i and node j displaced by h n are bonded across the boundary of a periodic template.
  bool bonded_across(int i, int j, const Eigen::Vector3i& n) const;
  /// Nodes bonded to node i within the same image, ascending.
  const std::int32_t* partners_begin(int i) const { return partners_.data() + first_partner_[i]; }
  const std::int32_t* partners_end(int i) const { return partners_.data() + first_partner_[i + 1]; }

private:
  int n_nodes_ = 0;
  std::vector<std::int64_t> first_bond_;
  std::vector<kernels::BondRecord> records_;
  std::vector<kernels::BondRecordOf<float>> single_records_;
  std::vector<std::int64_t> reach_;
  std::vector<ImageBond> image_bonds_;
  std::vector<std::int64_t> first_partner_;
  std::vector<std::int32_t> partners_;
};

} // namespace boba
