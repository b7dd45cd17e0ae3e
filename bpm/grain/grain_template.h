// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace boba {

/// One bond of a template: nodes `i < j` and the distance at which it carries no force.
struct Bond {
  int i = 0;
  int j = 0;
  double r0 = 0.0; ///< d
};

/// The undeformed arrangement of a grain's nodes and its bond network; every grain of one template shares it.
///
/// Invariants: nodes are sorted along a space-filling curve (a bond's two ends are near in memory), centred on their
/// mean; bonds have i < j, are sorted by (i, j) and unique. With `period` the template is a periodic cube or cuboid and
/// bonds may join a node to an image (their r0 is the nearest-image distance).
/// Source: docs/notation.md, "Grain".
struct GrainTemplate {
  std::vector<Eigen::Vector3d> position; ///< d, size n
  std::vector<Bond> bonds;
  std::optional<Eigen::Vector3d> period; ///< d; lengths of a periodic template, absent for a free grain
  double reference_volume = 0.0; ///< d^3; volume the grain stands for (n / bulk node density unless known better)

  int n_nodes() const { return static_cast<int>(position.size()); }
};

/// True when the arrangement is the undeformed one: every bond has its rest length, to a millionth.
bool is_at_rest(const GrainTemplate& grain);

/// Volume that a free grain of so many nodes stands for, d^3: a sphere of diameter d for one node, else n over the
/// bulk's density of nodes. Source: docs/notation.md, "Grain".
double nominal_volume(int n_nodes);

/// V0_i = sum of r0^3 over the bonds of node i (d^3), for every node.
/// Source: Clemmer, Hackney & Grest, bond force (unnumbered equation), "V_i ~ sum r^3".
std::vector<double> reference_node_volumes(int n_nodes, const std::vector<Bond>& bonds);

} // namespace boba
