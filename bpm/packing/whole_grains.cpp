// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/whole_grains.h"

#include <fmt/format.h>
#include <limits>
#include <stdexcept>

namespace boba {

namespace {

/// Neighbours of every node of a template, in compressed rows.
struct Neighbours {
  std::vector<int> first, other;

  explicit Neighbours(const GrainTemplate& grain_template) : first(grain_template.n_nodes() + 1, 0) {
    for (const Bond& bond : grain_template.bonds) {
      ++first[bond.i + 1];
      ++first[bond.j + 1];
    }
    for (std::size_t node = 1; node < first.size(); ++node) {
      first[node] += first[node - 1];
    }
    other.resize(first.back());
    std::vector<int> next(first.begin(), first.end() - 1);
    for (const Bond& bond : grain_template.bonds) {
      other[next[bond.i]++] = bond.j;
      other[next[bond.j]++] = bond.i;
    }
  }
};

/// Half of the smallest distance between opposite faces, over the periodic directions.
double longest_bond(const Box& box) {
  double half = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (box.periodic()[axis]) {
      half = std::min(half, 0.5 * box.face_distances()[axis]);
    }
  }
  return half;
}

/// Lattice numbers that bring `x` to the image nearest to `target`.
Vector3 images_towards(const Box& box, const Vector3& x, const Vector3& target) {
  Vector3 n = Vector3::Zero();
  const Vector3 s = box.h_inverse() * (target - x);
  for (int axis = 0; axis < 3; ++axis) {
    n[axis] = box.periodic()[axis] ? std::round(s[axis]) : 0.0;
  }
  return n;
}

/// Makes the grain whose nodes begin at `first` whole, in place.
void make_whole(const Packing& packing, int grain, std::int64_t first, const Neighbours& neighbours, const Box& box,
                std::span<Vector3> x) {
  const GrainTemplate& shape = packing.template_of(grain);
  const int n_nodes = shape.n_nodes();
  std::vector<bool> placed(n_nodes, false);
  std::vector<int> stack;
  Vector3 sum = Vector3::Zero();
  int n_first_piece = 0;
  for (int root = 0; root < n_nodes; ++root) {
    if (placed[root]) {
      continue;
    }
    if (root > 0) {
      x[root] += box.h() * images_towards(box, x[root], sum / n_first_piece);
    }
    const bool is_first_piece = root == 0;
    placed[root] = true;
    stack.assign(1, root);
    while (!stack.empty()) {
      const int node = stack.back();
      stack.pop_back();
      if (is_first_piece) {
        sum += x[node];
        ++n_first_piece;
      }
      for (int k = neighbours.first[node]; k < neighbours.first[node + 1]; ++k) {
        const int other = neighbours.other[k];
        if (!placed[other]) {
          placed[other] = true;
          x[other] += box.h() * images_towards(box, x[other], x[node]);
          stack.push_back(other);
        }
      }
    }
  }
  const double limit = longest_bond(box);
  for (const Bond& bond : shape.bonds) {
    const Vector3 difference = x[bond.i] - x[bond.j];
    const double length = box.minimum_image(difference).norm();
    const std::int64_t id_i = packing.id[first + bond.i], id_j = packing.id[first + bond.j];
    if (!(length < limit)) {
      throw std::invalid_argument(
          fmt::format("bond between nodes {} and {} is {:.6g} d long; it must be below {:.6g} d, "
                      "half the distance between opposite faces of the cell",
                      id_i, id_j, length, limit));
    }
    if (!shape.period && images_towards(box, x[bond.i], x[bond.j]) != Vector3::Zero()) {
      throw std::invalid_argument(fmt::format("bond between nodes {} and {} joins grain {} to its own periodic image",
                                              id_i, id_j, packing.grains[grain].molecule));
    }
  }
}

} // namespace

std::vector<Vector3> whole_positions(const Packing& packing, const Box& box, std::span<const Vector3> position) {
  std::vector<Vector3> whole(position.begin(), position.end());
  std::vector<Neighbours> neighbours;
  for (const auto& grain_template : packing.templates) {
    neighbours.emplace_back(*grain_template);
  }
  const std::vector<std::int64_t> first = packing.first_nodes();
  for (int grain = 0; grain < packing.n_grains(); ++grain) {
    const std::span<Vector3> nodes = std::span(whole).subspan(first[grain], first[grain + 1] - first[grain]);
    make_whole(packing, grain, first[grain], neighbours[packing.grains[grain].template_index], box, nodes);
  }
  return whole;
}

} // namespace boba
