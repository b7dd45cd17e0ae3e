// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/forces/point_list.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace boba {

namespace {

/// Beyond the reach, for the rounding of positions that are far from the cell, d.
constexpr double rounding = 1e-6;

/// Most cells for each node: more would be empty.
constexpr double most_cells_per_node = 2.0;

struct Candidate {
  int grain;         ///< of the second node
  ImageVector key;   ///< image of the higher grain, seen from the lower
  bool is_second;    ///< of two images of one grain: the one in the other direction
  std::int32_t slot; ///< of the second node
  ImageVector image;

  bool operator<(const Candidate& other) const {
    return std::tie(grain, key, is_second) < std::tie(other.grain, other.key, other.is_second);
  }
};

ImageVector negative(const ImageVector& n) {
  return {-n.a, -n.b, -n.c};
}

Candidate candidate_of(int grain, int other, std::int32_t slot, const ImageVector& image) {
  const bool turned = other < grain || (other == grain && image < ImageVector{});
  return {other, turned ? negative(image) : image, other == grain && turned, slot, image};
}

} // namespace

void PointList::sort_into_cells(std::span<const Vector3> position, const Box& box, double reach) {
  const auto n_nodes = static_cast<std::int32_t>(position.size());
  const double most = std::cbrt(std::max(1.0, most_cells_per_node * n_nodes));
  periodic_ = box.periodic();
  for (int axis = 0; axis < 3; ++axis) {
    const double share = (reach + rounding) * box.h_inverse().row(axis).norm(); // of the cell's height
    const double n = std::floor(0.999 / share);
    n_cells_[axis] = n < 3.0 ? 1 : static_cast<int>(std::min(n, std::max(3.0, std::ceil(2.0 * most))));
    most_shifts_[axis] = periodic_[axis] && n_cells_[axis] == 1 ? static_cast<int>(std::floor(share + 1.0)) : 0;
  }
  std::vector<std::int32_t> cell(n_nodes);
  std::vector<Vector3> inside(n_nodes);
  std::vector<ImageVector> turns(n_nodes);
  first_slot_.assign(static_cast<std::size_t>(n_cells_.prod()) + 1, 0);
  for (std::int32_t g = 0; g < n_nodes; ++g) {
    Vector3 s = box.to_fractional(position[g]);
    Eigen::Vector3i turn = Eigen::Vector3i::Zero(), place;
    for (int axis = 0; axis < 3; ++axis) {
      if (periodic_[axis] && std::abs(s[axis]) < 1e9) {
        turn[axis] = static_cast<int>(std::floor(s[axis]));
        s[axis] -= turn[axis];
      }
      place[axis] = s[axis] > 0.0 ? static_cast<int>(std::min(s[axis] * n_cells_[axis], n_cells_[axis] - 1.0)) : 0;
    }
    inside[g] = position[g] - box.h() * turn.cast<double>();
    turns[g] = {turn[0], turn[1], turn[2]};
    cell[g] = (place[2] * n_cells_[1] + place[1]) * n_cells_[0] + place[0];
    ++first_slot_[cell[g] + 1];
  }
  std::partial_sum(first_slot_.begin(), first_slot_.end(), first_slot_.begin());
  std::vector<std::int32_t> next(first_slot_.begin(), first_slot_.end() - 1);
  slot_of_.resize(n_nodes);
  grain_of_.resize(n_nodes);
  cell_.resize(n_nodes);
  in_cell_.resize(n_nodes);
  turns_.resize(n_nodes);
  for (std::int32_t g = 0; g < n_nodes; ++g) {
    const std::int32_t slot = next[cell[g]]++;
    slot_of_[g] = slot;
    grain_of_[slot] = g;
    cell_[slot] = cell[g];
    in_cell_[slot] = inside[g];
    turns_[slot] = turns[g];
  }
}

Eigen::Vector3i PointList::cell_of(std::int32_t slot) const {
  const int cell = cell_[slot], row = cell / n_cells_[0];
  return {cell % n_cells_[0], row % n_cells_[1], row / n_cells_[1]};
}

std::vector<PointList::Beside> PointList::beside(int axis, int cell) const {
  std::vector<Beside> found;
  const int n = n_cells_[axis];
  if (n == 1) {
    for (int shift = -most_shifts_[axis]; shift <= most_shifts_[axis]; ++shift) {
      found.push_back({0, shift});
    }
    return found;
  }
  for (int next = cell - 1; next <= cell + 1; ++next) {
    if (next >= 0 && next < n) {
      found.push_back({next, 0});
    } else if (periodic_[axis]) {
      found.push_back({next < 0 ? next + n : next - n, next < 0 ? -1 : 1});
    }
  }
  return found;
}

void PointList::build(std::span<const Vector3> position, const Box& box, double reach) {
  sort_into_cells(position, box, reach);
  const auto n_nodes = static_cast<std::int32_t>(position.size());
  chunks_.resize((n_nodes + chunk_size - 1) / chunk_size);
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < chunks_.size(); ++k) {
    chunks_[k].begin = static_cast<std::int32_t>(k) * chunk_size;
    search(chunks_[k], std::min(n_nodes, chunks_[k].begin + chunk_size), box, reach);
  }
}

void PointList::search(PointChunk& chunk, std::int32_t end, const Box& box, double reach) const {
  const double reach2 = (reach + rounding) * (reach + rounding);
  chunk.first.assign(1, 0);
  chunk.other.clear();
  chunk.image.clear();
  chunk.images.assign(1, ImageVector{});
  std::vector<Candidate> found;
  std::array<std::vector<Beside>, 3> around;
  int last_cell = -1;
  for (std::int32_t slot = chunk.begin; slot < end; ++slot) {
    found.clear();
    if (cell_[slot] != last_cell) {
      last_cell = cell_[slot];
      const Eigen::Vector3i cell = cell_of(slot);
      for (int axis = 0; axis < 3; ++axis) {
        around[axis] = beside(axis, cell[axis]);
      }
    }
    const int grain = grain_of_[slot];
    const ImageVector& own = turns_[slot];
    for (const auto& [z, shift_c] : around[2]) {
      for (const auto& [y, shift_b] : around[1]) {
        for (const auto& [x, shift_a] : around[0]) {
          const Vector3 at = in_cell_[slot] - box.h() * Vector3(shift_a, shift_b, shift_c);
          const int cell = (z * n_cells_[1] + y) * n_cells_[0] + x;
          for (std::int32_t other = first_slot_[cell]; other < first_slot_[cell + 1]; ++other) {
            if ((at - in_cell_[other]).squaredNorm() < reach2) {
              const ImageVector& turns = turns_[other];
              const ImageVector image = {own.a - turns.a + shift_a, own.b - turns.b + shift_b,
                                         own.c - turns.c + shift_c};
              if (other != slot || image != ImageVector{}) {
                found.push_back(candidate_of(grain, grain_of_[other], other, image));
              }
            }
          }
        }
      }
    }
    std::sort(found.begin(), found.end());
    for (const Candidate& candidate : found) {
      chunk.other.push_back(candidate.slot);
      if (candidate.image == ImageVector{}) {
        chunk.image.push_back(0);
        continue;
      }
      if (candidate.image != chunk.images.back()) {
        chunk.images.push_back(candidate.image);
      }
      chunk.image.push_back(static_cast<std::int32_t>(chunk.images.size()) - 1);
    }
    chunk.first.push_back(static_cast<std::int32_t>(chunk.other.size()));
  }
}

std::int64_t PointList::n_candidates() const {
  return std::accumulate(chunks_.begin(), chunks_.end(), std::int64_t{0}, [](std::int64_t n, const PointChunk& chunk) {
    return n + static_cast<std::int64_t>(chunk.other.size());
  });
}

std::size_t PointList::bytes() const {
  std::size_t bytes = grain_of_.capacity() * (3 * sizeof(int) + sizeof(Vector3) + sizeof(ImageVector)) +
                      first_slot_.capacity() * sizeof(std::int32_t);
  for (const PointChunk& chunk : chunks_) {
    bytes += (chunk.first.capacity() + chunk.other.capacity() + chunk.image.capacity()) * sizeof(std::int32_t) +
             chunk.images.capacity() * sizeof(ImageVector);
  }
  return bytes;
}

} // namespace boba
