// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/bond_network.h"

#include "bpm/grain/near_pairs.h"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>
#include <numeric>

namespace boba {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double firm_enough = 0.05; // smallest eigenvalue of sum e e^T that counts as held in all directions

int piece_of(std::vector<int>& parent, int node) {
  while (parent[node] != node) {
    node = parent[node] = parent[parent[node]];
  }
  return node;
}

int count_pieces(const GrainTemplate& grain) {
  std::vector<int> parent(grain.n_nodes());
  std::iota(parent.begin(), parent.end(), 0);
  int pieces = grain.n_nodes();
  for (const Bond& bond : grain.bonds) {
    const int a = piece_of(parent, bond.i), b = piece_of(parent, bond.j);
    if (a != b) {
      parent[a] = b;
      --pieces;
    }
  }
  return pieces;
}

} // namespace

std::vector<Bond> bonds_closer_than(const std::vector<Vector3d>& position, double cutoff,
                                    const std::optional<Vector3d>& period) {
  const auto shifts = image_shifts(period.value_or(Vector3d::Zero()));
  std::vector<Bond> bonds;
  for (const NearPair& pair : near_pairs(position, cutoff, period)) {
    bonds.push_back({pair.i, pair.j, (position[pair.i] - position[pair.j] - shifts[pair.shift]).norm()});
  }
  return bonds;
}

std::optional<std::string> floating_part(const GrainTemplate& grain) {
  std::vector<Matrix3d> held(grain.n_nodes(), Matrix3d::Zero());
  std::vector<int> n_bonds(grain.n_nodes(), 0);
  for (const Bond& bond : grain.bonds) {
    Vector3d e = grain.position[bond.i] - grain.position[bond.j];
    if (grain.period) {
      e = wrapped(e, *grain.period);
    }
    e /= bond.r0;
    for (const int node : {bond.i, bond.j}) {
      held[node] += e * e.transpose();
      ++n_bonds[node];
    }
  }
  for (int node = 0; node < grain.n_nodes(); ++node) {
    const double weakest = Eigen::SelfAdjointEigenSolver<Matrix3d>(held[node], Eigen::EigenvaluesOnly).eigenvalues()[0];
    if (weakest < firm_enough) {
      return fmt::format(
          "node {} at ({:.4g}, {:.4g}, {:.4g}) floats: {} bonds, smallest eigenvalue of sum e e^T {:.3g} "
          "(at least {} is needed)",
          node, grain.position[node].x(), grain.position[node].y(), grain.position[node].z(), n_bonds[node], weakest,
          firm_enough);
    }
  }
  if (const int pieces = count_pieces(grain); pieces != 1) {
    return fmt::format("the bond network is in {} pieces", pieces);
  }
  return std::nullopt;
}

} // namespace boba
