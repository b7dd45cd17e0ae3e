// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/grain/arrangement.h"

#include "bpm/grain/soft_relaxation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace boba {

namespace {

using Eigen::Vector3d;
using Eigen::Vector3i;

/// Half width of the uniform velocity components: the kinetic energy per node is half_width^2 / 2 = 0.1 k d^2.
const double velocity_half_width = std::sqrt(0.2);

/// The 4 n_x n_y n_z sites of a face-centred cuboid lattice that fills [-lengths/2, lengths/2).
std::vector<Vector3d> fcc_sites(const Vector3d& lengths, const Vector3i& cells) {
  const Vector3d cell = lengths.cwiseQuotient(cells.cast<double>());
  std::vector<Vector3d> sites;
  sites.reserve(4 * cells.prod());
  for (int iz = 0; iz < 2 * cells.z(); ++iz) {
    for (int iy = 0; iy < 2 * cells.y(); ++iy) {
      for (int ix = 0; ix < 2 * cells.x(); ++ix) {
        if ((ix + iy + iz) % 2 == 0) { // half-integer points with an even sum are the face-centred lattice
          const Vector3d half_steps(ix + 0.5, iy + 0.5, iz + 0.5);
          sites.push_back(0.5 * cell.cwiseProduct(half_steps) - 0.5 * lengths);
        }
      }
    }
  }
  return sites;
}

/// Cells along each side for at least n sites, as cubic as the lengths allow.
Vector3i cells_for(const Vector3d& lengths, int n) {
  const double edge = std::cbrt(4.0 * lengths.prod() / n);
  Vector3i cells = (lengths / edge).array().round().cast<int>().max(1);
  while (4LL * cells.cast<long long>().prod() < n) {
    int stretched = 0; // refine where the cells are longest
    lengths.cwiseQuotient(cells.cast<double>()).maxCoeff(&stretched);
    ++cells[stretched];
  }
  return cells;
}

std::vector<Vector3d> random_velocities(int n, Random& random) {
  std::vector<Vector3d> velocity(n);
  Vector3d mean = Vector3d::Zero();
  for (Vector3d& v : velocity) {
    v = random.vector(velocity_half_width);
    mean += v / n;
  }
  for (Vector3d& v : velocity) {
    v -= mean;
  }
  return velocity;
}

} // namespace

std::vector<Vector3d> bulk_arrangement(const Vector3d& period, int n, Random& random) {
  std::vector<Vector3d> position = fcc_sites(period, cells_for(period, n));
  while (static_cast<int>(position.size()) > n) { // vacancies where n does not fill the lattice
    position[random.below(position.size())] = position.back();
    position.pop_back();
  }
  std::vector<Vector3d> velocity = random_velocities(n, random);
  relax_soft_nodes(position, velocity, {.period = period, .wall_force = {}});
  return position;
}

std::vector<Vector3d> walled_arrangement(const Outline& outline, int n, Random& random) {
  const double edge = std::cbrt(4.0 * outline.volume() / n);
  const Vector3i cells = (2.0 * outline.half_lengths() / edge).array().ceil().cast<int>() + 2;
  const Vector3d lengths = edge * cells.cast<double>();
  std::vector<Vector3d> sites = fcc_sites(lengths, cells);
  const Vector3d offset = random.vector(0.25 * edge); // breaks the lattice's symmetry about the centre
  std::vector<double> reach(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) {
    sites[s] += offset;
    reach[s] = outline.reach(sites[s]);
  }
  std::vector<int> order(sites.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::pair(reach[a], a) < std::pair(reach[b], b); });
  std::vector<Vector3d> position(n);
  for (int i = 0; i < n; ++i) {
    position[i] = sites[order[i]];
  }
  std::vector<Vector3d> velocity = random_velocities(n, random);
  relax_soft_nodes(position, velocity,
                   {.period = {}, .wall_force = [&](const Vector3d& x) { return outline.wall_force(x); }});
  return position;
}

} // namespace boba
