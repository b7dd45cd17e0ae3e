// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/measure/non_affine.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <stdexcept>

namespace boba::measure {

namespace {

void check_count(std::size_t now, std::size_t before) {
  if (now != before) {
    throw std::invalid_argument(fmt::format("non-affine motion: {} grains after {}", now, before));
  }
}

/// Sorted numbers of a grain's neighbours; a grain met twice is there twice.
std::vector<int> sorted_grains(const std::vector<Neighbour>& list) {
  std::vector<int> grains(list.size());
  std::transform(list.begin(), list.end(), grains.begin(), [](const Neighbour& n) { return n.grain; });
  std::sort(grains.begin(), grains.end());
  return grains;
}

int count_missing(const std::vector<int>& from, const std::vector<int>& in) {
  std::vector<int> missing;
  std::set_difference(from.begin(), from.end(), in.begin(), in.end(), std::back_inserter(missing));
  return static_cast<int>(missing.size());
}

} // namespace

Matrix3 deformation_gradient(const Box& before, const Box& after, double strain_step) {
  if (!std::isfinite(strain_step)) {
    throw std::invalid_argument(fmt::format("deformation gradient: the strain step is {}", strain_step));
  }
  // Where the columns would be: lengths as they are now, tilts scaled with them, plus the shear.
  const double growth = after.h()(0, 0) / before.h()(0, 0);
  Matrix3 expected = growth * before.h();
  expected.row(0) += strain_step * expected.row(1);
  Matrix3 h = after.h();
  h.col(2) += std::round((expected(1, 2) - h(1, 2)) / h(1, 1)) * h.col(1);
  for (const int column : {1, 2}) {
    h.col(column) += std::round((expected(0, column) - h(0, column)) / h(0, 0)) * h.col(0);
  }
  return h * before.h_inverse();
}

NonAffineMotion::NonAffineMotion(const Box& box, std::span<const Vector3> centres,
                                 std::span<const Vector3> displacements)
    : box_(box), centre_(centres.begin(), centres.end()), displacement_(displacements.begin(), displacements.end()) {
  if (displacement_.empty()) {
    displacement_.assign(centres.size(), Vector3::Zero());
  }
  check_count(displacement_.size(), centre_.size());
}

void NonAffineMotion::add(const Box& box, std::span<const Vector3> centres, double strain_step) {
  check_count(centres.size(), centre_.size());
  const Matrix3 f = deformation_gradient(box_, box, strain_step);
  for (std::size_t g = 0; g < centres.size(); ++g) {
    displacement_[g] += (centres[g] - box.origin()) - f * (centre_[g] - box_.origin());
    centre_[g] = centres[g];
  }
  box_ = box;
}

double NonAffineMotion::mean_square() const {
  if (displacement_.empty()) {
    return 0.0;
  }
  Vector3 drift = Vector3::Zero();
  for (const Vector3& u : displacement_) {
    drift += u / static_cast<double>(displacement_.size());
  }
  double sum = 0.0;
  for (const Vector3& u : displacement_) {
    sum += (u - drift).squaredNorm();
  }
  return sum / static_cast<double>(displacement_.size());
}

std::vector<std::vector<Vector3>> neighbour_displacements(const NeighbourLists& neighbours,
                                                          std::span<const Vector3> before,
                                                          std::span<const Vector3> after, const Matrix3& f) {
  check_count(before.size(), neighbours.size());
  check_count(after.size(), neighbours.size());
  std::vector<std::vector<Vector3>> change(neighbours.size());
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    for (const Neighbour& neighbour : neighbours[i]) {
      const int j = neighbour.grain;
      const Vector3 image_shift = neighbour.vector - (before[j] - before[i]); // h n: moves with the cell
      change[i].push_back((after[j] - after[i]) - (before[j] - before[i]) + (f - Matrix3::Identity()) * image_shift);
    }
  }
  return change;
}

std::vector<double> minimal_non_affinity(const NeighbourLists& neighbours,
                                         const std::vector<std::vector<Vector3>>& displacement_change) {
  check_count(displacement_change.size(), neighbours.size());
  std::vector<double> d2_min(neighbours.size(), 0.0);
  for (std::size_t grain = 0; grain < neighbours.size(); ++grain) {
    check_count(displacement_change[grain].size(), neighbours[grain].size());
    Matrix3 x = Matrix3::Zero(), y = Matrix3::Zero();
    for (std::size_t j = 0; j < neighbours[grain].size(); ++j) {
      const Vector3& before = neighbours[grain][j].vector;
      const Vector3 after = before + displacement_change[grain][j];
      x += after * before.transpose();
      y += before * before.transpose();
    }
    const Eigen::FullPivLU<Matrix3> lu(y);
    if (!lu.isInvertible()) {
      continue;
    }
    const Matrix3 f = x * lu.inverse();
    for (std::size_t j = 0; j < neighbours[grain].size(); ++j) {
      const Vector3& before = neighbours[grain][j].vector;
      const Vector3 after = before + displacement_change[grain][j];
      d2_min[grain] += (after - f * before).squaredNorm() / static_cast<double>(neighbours[grain].size());
    }
  }
  return d2_min;
}

NeighbourChanges neighbour_changes(const NeighbourLists& before, const NeighbourLists& after) {
  check_count(after.size(), before.size());
  NeighbourChanges changes;
  for (std::size_t grain = 0; grain < before.size(); ++grain) {
    const auto then = sorted_grains(before[grain]), now = sorted_grains(after[grain]);
    changes.lost.push_back(count_missing(then, now));
    changes.gained.push_back(count_missing(now, then));
    changes.n_grains_changed += changes.lost.back() + changes.gained.back() > 0;
  }
  return changes;
}

} // namespace boba::measure
