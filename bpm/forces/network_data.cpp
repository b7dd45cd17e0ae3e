// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/network_data.h"

#include <algorithm>

namespace boba {

NetworkData::NetworkData(const GrainTemplate& grain) : n_nodes_(grain.n_nodes()) {
  const std::vector<double> volume = reference_node_volumes(n_nodes_, grain.bonds);
  first_bond_.assign(n_nodes_ + 1, 0);
  std::vector<std::vector<std::int32_t>> partners(n_nodes_);
  for (const Bond& bond : grain.bonds) {
    const double inverse_volume = 1.0 / (volume[bond.i] + volume[bond.j]);
    Eigen::Vector3i n = Eigen::Vector3i::Zero();
    if (grain.period) {
      const Eigen::Vector3d d = grain.position[bond.i] - grain.position[bond.j];
      n = d.cwiseQuotient(*grain.period).array().round().matrix().cast<int>();
    }
    if (n != Eigen::Vector3i::Zero()) {
      image_bonds_.push_back({bond.i, bond.j, n, bond.r0, inverse_volume});
      continue;
    }
    records_.push_back({bond.r0, 1.0 / bond.r0, inverse_volume, bond.j});
    ++first_bond_[bond.i + 1];
    partners[bond.i].push_back(bond.j);
    partners[bond.j].push_back(bond.i);
  }
  for (int i = 0; i < n_nodes_; ++i) {
    first_bond_[i + 1] += first_bond_[i];
  }
  for (const kernels::BondRecord& bond : records_) {
    single_records_.push_back({static_cast<float>(bond.r0), static_cast<float>(bond.inverse_r0),
                               static_cast<float>(bond.inverse_volume), bond.other});
  }
  std::int64_t reach = 0;
  for (int i = 0; i < n_nodes_; ++i) {
    reach = std::max<std::int64_t>(reach, i + 1);
    for (std::int64_t b = first_bond_[i]; b < first_bond_[i + 1]; ++b) {
      reach = std::max<std::int64_t>(reach, records_[b].other + 1);
    }
    reach_.push_back(reach);
  }
  first_partner_.push_back(0);
  for (std::vector<std::int32_t>& list : partners) {
    std::sort(list.begin(), list.end());
    partners_.insert(partners_.end(), list.begin(), list.end());
    first_partner_.push_back(static_cast<std::int64_t>(partners_.size()));
  }
}

bool NetworkData::bonded_across(int i, int j, const Eigen::Vector3i& n) const {
  return std::any_of(image_bonds_.begin(), image_bonds_.end(), [&](const ImageBond& bond) {
    return (bond.i == i && bond.j == j && bond.n == n) || (bond.j == i && bond.i == j && bond.n == -n);
  });
}

} // namespace boba
