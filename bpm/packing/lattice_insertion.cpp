// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/lattice_insertion.h"

#include "bpm/grain/random.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdexcept>
#include <utility>

namespace boba {

namespace {

/// A conventional cell with orthogonal edges; nearest neighbours are 1 apart.
struct UnitCell {
  Vector3 edges;
  std::vector<Vector3> sites; ///< fractional
};

UnitCell unit_cell(Arrangement arrangement) {
  switch (arrangement) {
  case Arrangement::fcc:
    return {Vector3::Constant(std::sqrt(2.0)), {{0, 0, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {0.5, 0.5, 0}}};
  case Arrangement::bcc:
    return {Vector3::Constant(2.0 / std::sqrt(3.0)), {{0, 0, 0}, {0.5, 0.5, 0.5}}};
  case Arrangement::hcp:
    return {{1.0, std::sqrt(3.0), std::sqrt(8.0 / 3.0)},
            {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 5.0 / 6.0, 0.5}, {0, 1.0 / 3.0, 0.5}}};
  default:
    return {Vector3::Ones(), {{0, 0, 0}}};
  }
}

/// Longest edge of the repeated cell over its shortest.
double elongation(const UnitCell& cell, const std::array<int, 3>& n) {
  const Vector3 edges = cell.edges.cwiseProduct(Vector3(n[0], n[1], n[2]));
  return edges.maxCoeff() / edges.minCoeff();
}

std::optional<std::array<int, 3>> cubic_repetitions(std::int64_t n_cells) {
  const auto n = static_cast<int>(std::lround(std::cbrt(static_cast<double>(n_cells))));
  return n > 0 && static_cast<std::int64_t>(n) * n * n == n_cells ? std::optional(std::array{n, n, n}) : std::nullopt;
}

std::optional<std::array<int, 3>> compact_repetitions(const UnitCell& cell, std::int64_t n_cells) {
  constexpr double longest = 1.3;
  // No edge of such a cell is longer than 1.3 times that of the cube of the same volume.
  const double cube = std::cbrt(static_cast<double>(n_cells) * cell.edges.prod());
  std::optional<std::array<int, 3>> best;
  for (int n0 = 1; n0 * cell.edges[0] <= longest * cube; ++n0) {
    for (int n1 = 1; n_cells % n0 == 0 && n1 * cell.edges[1] <= longest * cube; ++n1) {
      const std::array<int, 3> n = {n0, n1, static_cast<int>(n_cells / n0 / n1)};
      if (n_cells / n0 % n1 == 0 && elongation(cell, n) <= longest &&
          (!best || elongation(cell, n) < elongation(cell, *best))) {
        best = n;
      }
    }
  }
  return best;
}

/// The next count below (step -1) or above (step 1) that fills the lattice; 0 without one.
std::int64_t next_count(Arrangement arrangement, std::int64_t count, int step) {
  for (std::int64_t n = count + step; n > 0 && n < 8 * count + 64; n += step) {
    if (lattice_repetitions(arrangement, n)) {
      return n;
    }
  }
  return 0;
}

} // namespace

std::vector<std::string> arrangement_names() {
  return {"random", "fcc", "hcp", "bcc", "sc"};
}

std::string name_of(Arrangement arrangement) {
  return arrangement_names()[static_cast<std::size_t>(arrangement)];
}

Arrangement arrangement_named(const std::string& name) {
  const std::vector<std::string> names = arrangement_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument(
        fmt::format("arrangement = \"{}\" is not known; there are {}", name, fmt::join(names, ", ")));
  }
  return static_cast<Arrangement>(found - names.begin());
}

std::optional<std::array<int, 3>> lattice_repetitions(Arrangement arrangement, std::int64_t count) {
  const UnitCell cell = unit_cell(arrangement);
  const int n_sites = static_cast<int>(cell.sites.size());
  if (count < 1 || count % n_sites != 0) {
    return std::nullopt;
  }
  return arrangement == Arrangement::hcp ? compact_repetitions(cell, count / n_sites)
                                         : cubic_repetitions(count / n_sites);
}

void check_lattice_count(Arrangement arrangement, std::int64_t count) {
  if (arrangement == Arrangement::random || lattice_repetitions(arrangement, count)) {
    return;
  }
  const std::int64_t below = next_count(arrangement, count, -1), above = next_count(arrangement, count, 1);
  throw std::invalid_argument(
      fmt::format("{} grains do not fill a {} lattice; the next counts that do are {}", count, name_of(arrangement),
                  below > 0 ? fmt::format("{} and {}", below, above) : fmt::format("{}", above)));
}

Packing insert_on_lattice(const Insertion& insertion, Arrangement arrangement) {
  const int count = static_cast<int>(insertion.grains.size());
  check_lattice_count(arrangement, count);
  if (arrangement == Arrangement::random || count == 0 || !(insertion.packing_fraction > 0.0)) {
    throw std::invalid_argument(fmt::format("insert on a lattice: {} grains at packing_fraction = {}; both must be "
                                            "positive, and the arrangement a lattice",
                                            count, insertion.packing_fraction));
  }
  const UnitCell cell = unit_cell(arrangement);
  const std::array<int, 3> n = *lattice_repetitions(arrangement, count);
  const Vector3 shape = cell.edges.cwiseProduct(Vector3(n[0], n[1], n[2])); // with neighbours 1 apart
  double volume = 0.0, radius = 0.0;
  for (const Grain& grain : insertion.grains) {
    volume += insertion.templates[grain.template_index]->reference_volume;
    radius = std::max(radius, bounding_radius(*insertion.templates[grain.template_index], insertion.diameter));
  }
  const double distance = std::cbrt(volume / insertion.packing_fraction / shape.prod());
  if (distance < 2.0 * radius) {
    throw std::invalid_argument(fmt::format(
        "insert: at packing_fraction = {:g} neighbours of the {} lattice are {:.4g} d apart, and the largest grain's "
        "bounding sphere (radius to the outermost node plus d/2) is {:.4g} d across. Allowed for these grains: at most "
        "{:.3f}; compress afterwards",
        insertion.packing_fraction, name_of(arrangement), distance, 2.0 * radius,
        insertion.packing_fraction * std::pow(distance / (2.0 * radius), 3)));
  }
  Random random(insertion.seed);
  std::vector<Grain> grains = insertion.grains;
  for (std::size_t i = grains.size(); i-- > 1;) { // every order of the grains is equally likely
    std::swap(grains[i], grains[std::min(i, static_cast<std::size_t>(random.uniform() * static_cast<double>(i + 1)))]);
  }
  const Box box(Vector3::Zero(), distance * shape);
  std::vector<Placement> placements;
  for (int k = 0; k < n[0] * n[1] * n[2]; ++k) {
    const Vector3 corner(k % n[0], k / n[0] % n[1], k / (n[0] * n[1]));
    for (const Vector3& site : cell.sites) {
      // Off the cell's faces: a site on one belongs to either side by rounding.
      const Vector3 centre = distance * cell.edges.cwiseProduct(corner + site + Vector3::Constant(0.05));
      const Eigen::Quaterniond turn = insertion.rotate ? random_rotation(random) : Eigen::Quaterniond::Identity();
      placements.push_back({grains[placements.size()], centre, turn});
    }
  }
  return make_packing(box, insertion.templates, placements);
}

} // namespace boba
