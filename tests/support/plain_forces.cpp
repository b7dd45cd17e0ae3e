// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/plain_forces.h"

#include <cmath>
#include <set>
#include <utility>

namespace boba::test {

namespace {

using Real = long double;

struct Pair {
  Real d[3], r, vn;
};

Pair pair_of(const Vector3& xi, const Vector3& xj, const Vector3& vi, const Vector3& vj) {
  Pair pair{};
  Real r2 = 0, dv = 0;
  for (int c = 0; c < 3; ++c) {
    pair.d[c] = static_cast<Real>(xi[c]) - xj[c];
    r2 += pair.d[c] * pair.d[c];
    dv += pair.d[c] * (static_cast<Real>(vi[c]) - vj[c]);
  }
  pair.r = std::sqrt(r2);
  pair.vn = dv / pair.r;
  return pair;
}

void add(PlainForces& sums, std::size_t i, const Pair& pair, Real f, double virial_share) {
  for (int a = 0; a < 3; ++a) {
    const Real component = f * pair.d[a] / pair.r;
    sums.force[i][a] += static_cast<double>(component);
    for (int b = 0; b < 3; ++b) {
      sums.virial(a, b) += virial_share * static_cast<double>(component * pair.d[b]);
    }
  }
}

using Bonded = std::set<std::pair<std::int64_t, std::int64_t>>;

/// Adds the forces of the whole bonds, and tells who is bonded to whom.
Bonded add_bonds(const Packing& packing, const Material& m, PlainForces& sums) {
  const std::vector<Vector3>& x = packing.position;
  const std::vector<Vector3>& v = packing.velocity;
  const std::vector<std::int64_t> first = packing.first_nodes();
  Bonded bonded;
  for (int g = 0; g < packing.n_grains(); ++g) {
    std::vector<Real> volume(packing.template_of(g).n_nodes(), 0), volume0 = volume;
    const double limit = packing.grains[g].breaking.strain;
    const auto is_broken = [&](const Bond& bond) {
      const Real r = pair_of(x[first[g] + bond.i], x[first[g] + bond.j], v[0], v[0]).r;
      return limit > 0.0 && std::abs(r - bond.r0) > limit * bond.r0;
    };
    for (const Bond& bond : packing.template_of(g).bonds) {
      if (is_broken(bond)) {
        continue;
      }
      const Real r = pair_of(x[first[g] + bond.i], x[first[g] + bond.j], v[0], v[0]).r;
      for (const int node : {bond.i, bond.j}) {
        volume[node] += r * r * r;
        volume0[node] += static_cast<Real>(bond.r0) * bond.r0 * bond.r0;
      }
    }
    for (const Bond& bond : packing.template_of(g).bonds) {
      if (is_broken(bond)) {
        continue;
      }
      const std::int64_t i = first[g] + bond.i, j = first[g] + bond.j;
      bonded.insert({i, j});
      bonded.insert({j, i});
      const Pair pair = pair_of(x[i], x[j], v[i], v[j]);
      const Real q = (volume[bond.i] + volume[bond.j]) / (volume0[bond.i] + volume0[bond.j]);
      const Real f =
          m.k * (bond.r0 - pair.r) + packing.grains[g].alpha * (std::cbrt(q) - pair.r / bond.r0) - m.gamma * pair.vn;
      add(sums, i, pair, f, 1.0);
      add(sums, j, pair, -f, 0.0);
    }
  }
  return bonded;
}

/// Adds the forces of all other pairs, images included; each contact counts twice.
void add_contacts(const Packing& packing, const Material& m, int n_images, const Matrix3& velocity_of_cell,
                  const Bonded& bonded, PlainForces& sums) {
  const std::vector<Vector3>& x = packing.position;
  const std::vector<Vector3>& v = packing.velocity;
  const auto& periodic = packing.box.periodic();
  const auto images = [&](int axis) { return periodic[axis] ? n_images : 0; };
  std::vector<Vector3> shifts, shift_velocities;
  for (int a = -images(0); a <= images(0); ++a) {
    for (int b = -images(1); b <= images(1); ++b) {
      for (int c = -images(2); c <= images(2); ++c) {
        shifts.emplace_back(packing.box.h() * Vector3(a, b, c));
        shift_velocities.emplace_back(velocity_of_cell * Vector3(a, b, c));
      }
    }
  }
  const std::vector<int> grain = packing.topology(false).grain_of_node();
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) {
      const Vector3 d = x[i] - x[j];
      for (std::size_t k = 0; k < shifts.size(); ++k) {
        const bool home = shifts[k].isZero(0.0);
        const double diameter = home && grain[i] == grain[j] ? m.diameter : m.contact_diameter.value_or(m.diameter);
        if (!((d - shifts[k]).squaredNorm() < diameter * diameter)) {
          continue;
        }
        if (home && (i == j || bonded.count({static_cast<std::int64_t>(i), static_cast<std::int64_t>(j)}) > 0)) {
          continue;
        }
        const Pair pair = pair_of(x[i], x[j] + shifts[k], v[i], v[j] + shift_velocities[k]);
        const Real overlap = diameter - pair.r;
        const Real f = m.k * overlap + m.k3 * overlap * overlap * overlap -
                       m.gamma * (1 - std::pow(pair.r / diameter, 8)) * pair.vn;
        add(sums, i, pair, f, 0.5);
        ++sums.n_contacts;
      }
    }
  }
}

} // namespace

PlainForces plain_forces(const Packing& packing, const Material& m, int n_images, const Matrix3& velocity_of_cell) {
  PlainForces sums;
  sums.force.assign(packing.position.size(), Vector3::Zero());
  const Bonded bonded = add_bonds(packing, m, sums);
  add_contacts(packing, m, n_images, velocity_of_cell, bonded, sums);
  sums.n_contacts /= 2;
  return sums;
}

} // namespace boba::test
