// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/measure/neighbours.h"

#include <span>
#include <vector>

namespace boba::measure {

/// The deformation gradient that takes one cell into a later one, F = h_after h_before^-1, flips undone.
///
/// A flipped cell is another basis of the same lattice: of h_after + (lattice vectors) the columns that lie nearest to
/// the mapped columns of before are taken. `strain_step`, the shear strain between the two, says where they should be:
/// any step is followed, while without it (0) the cell must shear by less than half a cell.
/// \throws std::invalid_argument for a strain that is not finite.
Matrix3 deformation_gradient(const Box& before, const Box& after, double strain_step = 0.0);

/// Non-affine motion of grain centres, summed up from frame to frame.
///
/// u(t_n) = sum over frames of [x(t_k+1) - o_k+1 - F_k (x(t_k) - o_k)], where o is the box origin: what is left of the
/// path when the box's own flow is taken away. Frames must be close: the flow is followed in straight pieces.
class NonAffineMotion {
public:
  /// \param centres unwrapped, d
  /// \param displacements so far, d, for a motion that goes on; none: this is the first frame
  NonAffineMotion(const Box& box, std::span<const Vector3> centres, std::span<const Vector3> displacements = {});
  /// Takes in the next frame. `strain_step` as in deformation_gradient.
  void add(const Box& box, std::span<const Vector3> centres, double strain_step);

  const std::vector<Vector3>& displacements() const { return displacement_; } ///< per grain, since the first frame, d
  double mean_square() const; ///< of the displacements, about their mean (the packing may drift as a whole), d^2

private:
  Box box_;
  std::vector<Vector3> centre_, displacement_;
};

/// d_j(after) - d_j(before) of every neighbour vector, for `minimal_non_affinity`: the same pair and the same periodic
/// copy, which moves with the cell: (x_j - x_i)(after) - (x_j - x_i)(before) + (F - 1) (d_j - x_j + x_i)(before), d.
///
/// \param neighbours vectors in the first frame  \param f deformation_gradient between the frames
/// \throws std::invalid_argument when the numbers of grains differ.
std::vector<std::vector<Vector3>> neighbour_displacements(const NeighbourLists& neighbours,
                                                          std::span<const Vector3> before,
                                                          std::span<const Vector3> after, const Matrix3& f);

/// How much the neighbourhood of each grain changed other than by a uniform strain, per neighbour:
/// D2_min = min over F of (1/n) sum_j |d_j(after) - F d_j(before)|^2, d^2.
///
/// \param neighbours vectors in the first frame
/// \param displacement_change per grain and neighbour list entry: d_j(after) - d_j(before), d
/// Grains whose neighbours do not span space get 0.
/// Source: Falk, Langer, Phys. Rev. E 57, 7192 (1998).
std::vector<double> minimal_non_affinity(const NeighbourLists& neighbours,
                                         const std::vector<std::vector<Vector3>>& displacement_change);

/// Neighbour bonds that are in one list and not in the other, per grain: rearrangement events between two frames.
struct NeighbourChanges {
  std::vector<int> lost, gained;
  int n_grains_changed = 0;
};
/// Which periodic copy a neighbour is plays no part (a flip renames the copies).
/// \throws std::invalid_argument when the numbers of grains differ.
NeighbourChanges neighbour_changes(const NeighbourLists& before, const NeighbourLists& after);

} // namespace boba::measure
