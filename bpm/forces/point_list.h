// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/forces/grain_neighbours.h"
#include "bpm/forces/kernels/kernels.h"
#include "bpm/packing/box.h"

#include <cstdint>
#include <span>
#include <vector>

namespace boba {

/// A part of the candidates: those of nodes that follow each other in space.
struct PointChunk {
  std::int32_t begin = 0;          ///< first slot
  std::vector<std::int32_t> first; ///< per slot of the chunk, and one more: its first candidate
  std::vector<std::int32_t> other; ///< per candidate: slot of the second node
  std::vector<std::int32_t> image; ///< per candidate: place in `images`
  std::vector<ImageVector> images; ///< of second nodes; 0 first

  std::int32_t n_slots() const { return static_cast<std::int32_t>(first.size()) - 1; }
};

/// Candidate contacts of grains of one node each: all pairs closer than a reach, images included, from one cell list.
///
/// Nodes get slots in the order of the cells, so that neighbours lie near each other in memory. Those of a slot are
/// sorted as ContactList sorts pairs (by the two grains, then by the image of the second): forces are then the same to
/// the last bit. Exact for any cell, also one that is thinner than the reach.
/// Cost: about 30 distances per node, and the sort of what is found.
class PointList {
public:
  /// Slots in a chunk: what one thread evaluates at a time.
  static constexpr std::int32_t chunk_size = 128;

  /// \param position of every grain's node, d
  void build(std::span<const Vector3> position, const Box& box, double reach);

  const std::vector<PointChunk>& chunks() const { return chunks_; }
  int grain_of(std::int32_t slot) const { return grain_of_[slot]; }
  std::int32_t slot_of(int grain) const { return slot_of_[grain]; }
  std::int64_t n_candidates() const; ///< each pair of nodes counts twice
  std::size_t bytes() const;

private:
  /// A row of cells beside the present one along an axis, and the lattice vectors that lead there.
  struct Beside {
    int cell, shift;
  };
  void sort_into_cells(std::span<const Vector3> position, const Box& box, double reach);
  std::vector<Beside> beside(int axis, int cell) const;
  void search(PointChunk& chunk, std::int32_t end, const Box& box, double reach) const;
  Eigen::Vector3i cell_of(std::int32_t slot) const;

  Eigen::Vector3i n_cells_ = Eigen::Vector3i::Ones();
  std::array<bool, 3> periodic_ = {true, true, true};
  Eigen::Vector3i most_shifts_ = Eigen::Vector3i::Zero(); ///< along directions of one cell
  std::vector<std::int32_t> first_slot_;                  ///< per cell, and one more
  std::vector<int> grain_of_;                             ///< per slot
  std::vector<std::int32_t> slot_of_;                     ///< per grain
  std::vector<std::int32_t> cell_;                        ///< per slot
  std::vector<Vector3> in_cell_;                          ///< per slot: position inside the cell, d
  std::vector<ImageVector> turns_;                        ///< per slot: lattice vectors between the two
  std::vector<PointChunk> chunks_;
};

} // namespace boba
