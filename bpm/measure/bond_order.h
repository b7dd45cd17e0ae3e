// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/neighbours.h"

#include <array>
#include <string_view>
#include <vector>

namespace boba::measure {

/// Local structure of a grain. The numbers are those written to files.
enum class CrystalClass { disordered = 0, fcc = 1, hcp = 2, bcc = 3, unknown = 4 };
constexpr int n_crystal_classes = 5;

std::string_view name_of(CrystalClass crystal);

struct BondOrderOptions {
  double solid_bond_cosine = 0.7; ///< a bond is solid-like above this correlation of q6 at its ends; within (-1, 1)
  int min_solid_bonds = 7;        ///< a grain with at least this many solid-like bonds is ordered
};

/// Bond-orientational order of one grain.
struct BondOrder {
  double q4 = 0.0, q6 = 0.0;                   ///< of the grain's own neighbours
  double averaged_q4 = 0.0, averaged_q6 = 0.0; ///< of the mean of q_lm over the grain and its neighbours
  double averaged_w4 = 0.0, averaged_w6 = 0.0; ///< third-order invariants of the same mean, normalised
  int n_neighbours = 0;
  std::vector<bool> solid; ///< per neighbour: its bond is solid-like
  int n_solid_bonds = 0;
  CrystalClass crystal = CrystalClass::disordered;
};

/// Bond-orientational order of every grain.
///
/// q_lm = sum_j w_j Y_lm(r_j) / sum_j w_j over its neighbours; q_l = sqrt(4 pi / (2 l + 1) sum_m |q_lm|^2).
/// A bond i-j is solid-like when Re sum_m q_6m(i) q_6m(j)* / (|q_6(i)| |q_6(j)|) > solid_bond_cosine. Ordered grains
/// are bcc where averaged_w6 > 0, else fcc where averaged_w4 < 0, else hcp: signs that need no threshold, and that tell
/// strained lattices wrong (docs/formats-measure.md; match_templates does not). A bond to the grain's own periodic copy
/// is never solid-like, and a grain with one is unknown: a copy agrees with itself whatever the arrangement is.
/// \throws std::invalid_argument for options out of range or a list that names a grain that does not exist.
/// Source: Steinhardt, Nelson, Ronchetti, Phys. Rev. B 28, 784 (1983); ten Wolde, Ruiz-Montero, Frenkel, J. Chem.
/// Phys. 104, 9932 (1996); Lechner, Dellago, J. Chem. Phys. 129, 114707 (2008); weights: Mickel et al., J. Chem. Phys.
/// 138, 044501 (2013).
std::vector<BondOrder> bond_order(const NeighbourLists& neighbours, const BondOrderOptions& options = {});

/// Number of grains of each class, indexed by CrystalClass.
std::array<int, n_crystal_classes> count_classes(const std::vector<BondOrder>& orders);

} // namespace boba::measure
