// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/stability/twin.h"

#include "bpm/laws/bond.h"
#include "bpm/laws/contact.h"

#include <cmath>

namespace boba::bench {

namespace {

using Real = Twin::Real;
using Vector = Twin::Vector;

constexpr int search_interval = 20;
constexpr double margin = 1.0; ///< d; the runs it is made for move far less in so many steps

Real dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector minus(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// The nearest image's lattice vector, whose numbers are those of the cell itself: the same in every precision.
Vector nearest(const Vector& difference, const Box& box) {
  const Vector3 d(static_cast<double>(difference[0]), static_cast<double>(difference[1]),
                  static_cast<double>(difference[2]));
  const Vector3 n = (box.h_inverse() * d).array().round();
  Vector result = difference;
  for (int c = 0; c < 3; ++c) {
    if (box.periodic()[c]) {
      for (int a = 0; a < 3; ++a) {
        result[a] -= static_cast<Real>(box.h()(a, c)) * static_cast<Real>(n[c]);
      }
    }
  }
  return result;
}

void push(std::vector<Vector>& f, std::int64_t i, std::int64_t j, const Vector& d, Real f_over_r) {
  for (int c = 0; c < 3; ++c) {
    f[i][c] += f_over_r * d[c];
    f[j][c] -= f_over_r * d[c];
  }
}

} // namespace

Twin::Twin(const Packing& packing, const Material& material, double dt)
    : packing_(packing), material_(material), dt_(dt), first_(packing.first_nodes()) {
  for (std::size_t i = 0; i < packing.position.size(); ++i) {
    x_.push_back({packing.position[i][0], packing.position[i][1], packing.position[i][2]});
    v_.push_back({packing.velocity[i][0], packing.velocity[i][1], packing.velocity[i][2]});
  }
  for (const auto& grain : packing.templates) {
    const auto n = static_cast<std::size_t>(grain->n_nodes());
    bonded_.emplace_back(n * n, 0);
    for (const Bond& bond : grain->bonds) {
      bonded_.back()[bond.i * n + bond.j] = bonded_.back()[bond.j * n + bond.i] = 1;
    }
  }
  find_contacts();
}

void Twin::find_contacts() {
  near_.clear();
  const std::vector<int> grain_of = packing_.topology(false).grain_of_node();
  const auto n = static_cast<std::int64_t>(x_.size());
  for (std::int64_t i = 0; i < n; ++i) {
    for (std::int64_t j = i + 1; j < n; ++j) {
      const int g = grain_of[i];
      if (grain_of[j] == g) {
        const auto m = static_cast<std::int64_t>(packing_.template_of(g).n_nodes());
        if (bonded_[packing_.grains[g].template_index][(i - first_[g]) * m + j - first_[g]] != 0) {
          continue;
        }
      }
      const Vector d = nearest(minus(x_[i], x_[j]), packing_.box);
      if (static_cast<double>(dot(d, d)) < (material_.diameter + margin) * (material_.diameter + margin)) {
        near_.push_back({i, j});
      }
    }
  }
}

void Twin::add_bonds() {
  for (int g = 0; g < packing_.n_grains(); ++g) {
    const GrainTemplate& grain = packing_.template_of(g);
    const Real alpha = packing_.grains[g].alpha;
    std::vector<Real> volume(grain.n_nodes(), 0), volume0(grain.n_nodes(), 0);
    for (const Bond& bond : grain.bonds) {
      const Vector d = minus(x_[first_[g] + bond.i], x_[first_[g] + bond.j]);
      const Real r = std::sqrt(dot(d, d)), r0 = bond.r0;
      for (const int node : {bond.i, bond.j}) {
        volume[node] += r * r * r;
        volume0[node] += r0 * r0 * r0;
      }
    }
    for (const Bond& bond : grain.bonds) {
      const std::int64_t i = first_[g] + bond.i, j = first_[g] + bond.j;
      const Vector d = minus(x_[i], x_[j]);
      const Real r = std::sqrt(dot(d, d)), r0 = bond.r0;
      const Real q = std::cbrt((volume[bond.i] + volume[bond.j]) / (volume0[bond.i] + volume0[bond.j]));
      const Real f =
          bond_law(material_).in<Real>().force<Real>(alpha, r, r0, 1 / r0, q, dot(d, minus(v_[i], v_[j])) / r);
      push(f_, i, j, d, f / r);
    }
  }
}

void Twin::add_contacts() {
  const ContactLaw law{material_.k, material_.gamma, material_.k3, material_.diameter};
  for (const NodePair& pair : near_) {
    const Vector d = nearest(minus(x_[pair.i], x_[pair.j]), packing_.box);
    const Real r2 = dot(d, d), reach = material_.diameter;
    if (r2 < reach * reach) {
      const Real r = std::sqrt(r2);
      const Real f = law.force<Real>(r, dot(d, minus(v_[pair.i], v_[pair.j])) / r);
      push(f_, pair.i, pair.j, d, f / r);
    }
  }
}

void Twin::kick(Real dt) {
  f_.assign(x_.size(), Vector{0, 0, 0});
  add_contacts();
  add_bonds();
  for (std::size_t i = 0; i < v_.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      v_[i][c] += dt * f_[i][c] / static_cast<Real>(material_.node_mass);
    }
  }
}

void Twin::advance() {
  for (std::size_t i = 0; i < x_.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      x_[i][c] += dt_ * v_[i][c];
    }
  }
  if (++steps_ % search_interval == 0) {
    find_contacts();
  }
  kick(dt_);
}

Real Twin::kinetic_energy() const {
  Real sum = 0;
  for (const Vector& v : v_) {
    sum += dot(v, v) * static_cast<Real>(material_.node_mass) / 2;
  }
  return sum;
}

} // namespace boba::bench
