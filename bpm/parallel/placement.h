// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/lane_layout.h"
#include "bpm/packing/packing.h"
#include "bpm/parallel/distribution.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boba {

/// Place of a point of the unit cube along a Hilbert curve of 2^10 cells a side.
std::uint64_t place_along_curve(const Vector3& fractional);

/// What placement looks at.
struct PlacementInput {
  const Packing* packing = nullptr;
  int n_ranks = 1;
  int block_lanes = 8;             ///< lanes of a full block
  std::vector<Vector3> fractional; ///< grain centres in units of the cell, any image
  std::vector<double> cost;        ///< of each grain, any unit
};

/// Owner of every grain: grains that share blocks (same template, alpha = 0 or not) are laid along a Hilbert curve
/// through the cell and the curve is cut into pieces of equal cost, one a rank. Cuts fall between full blocks of lanes
/// as long as there is a block for every rank.
std::vector<int> place_grains(const PlacementInput& input);

/// Largest cost of any rank over the mean, 1 when they are balanced. A block costs as much as its lanes, filled or not.
double imbalance(const PlacementInput& input, std::span<const int> owner);

/// A rank's grains in the order in which they fill blocks: along the curve, so that a block is compact.
std::vector<int> along_curve(std::span<const int> grains, std::span<const Vector3> fractional);

/// Owners of a packing's grains by where they are; a grain costs what it has nodes.
Distribution distribute(const Packing& packing, const Ranks& ranks, Precision precision);

/// This rank's grains, in the order in which they fill blocks.
std::vector<int> own_grains(const Packing& packing, const Distribution& distribution);

} // namespace boba
