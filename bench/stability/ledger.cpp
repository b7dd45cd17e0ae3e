// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/stability/ledger.h"

#include "bpm/laws/bond.h"
#include "bpm/laws/contact.h"

#include <cmath>

namespace boba::bench {

Ledger::Ledger(const Packing& packing, const Material& material)
    : packing_(packing), material_(material), first_(packing.first_nodes()) {
  for (const auto& grain : packing.templates) {
    const auto n = static_cast<std::size_t>(grain->n_nodes());
    bonded_.emplace_back(n * n, 0);
    for (const Bond& bond : grain->bonds) {
      bonded_.back()[bond.i * n + bond.j] = bonded_.back()[bond.j * n + bond.i] = 1;
    }
    periodic_template_ = periodic_template_ || grain->period;
  }
}

void Ledger::bonds(const Snapshot& s, const Matrix3& gradient, Powers& powers) const {
  for (int g = 0; g < packing_.n_grains(); ++g) {
    const GrainTemplate& grain = packing_.template_of(g);
    const double alpha = packing_.grains[g].alpha;
    std::vector<double> volume(grain.n_nodes(), 0.0), volume0(grain.n_nodes(), 0.0);
    std::vector<Vector3> difference;
    for (const Bond& bond : grain.bonds) {
      Vector3 d = s.position[first_[g] + bond.i] - s.position[first_[g] + bond.j];
      if (grain.period) {
        d = s.box.minimum_image(d);
      }
      difference.push_back(d);
      for (const int node : {bond.i, bond.j}) {
        volume[node] += std::pow(d.norm(), 3);
        volume0[node] += std::pow(bond.r0, 3);
      }
    }
    for (std::size_t b = 0; b < grain.bonds.size(); ++b) {
      const Bond& bond = grain.bonds[b];
      const double r = difference[b].norm();
      const Vector3 e = difference[b] / r;
      const double peculiar = e.dot(s.velocity[first_[g] + bond.i] - s.velocity[first_[g] + bond.j]);
      const double affine = e.dot(gradient * difference[b]);
      const double q = (volume[bond.i] + volume[bond.j]) / (volume0[bond.i] + volume0[bond.j]);
      const double many_body = alpha * (std::cbrt(q) - r / bond.r0);
      const BondLaw law = bond_law(material_);
      const double damping = -law.gamma * peculiar;
      powers.bonds += law.energy(r, bond.r0);
      powers.many_body += many_body * (peculiar + affine);
      powers.damping -= damping * peculiar;
      powers.damping_box -= damping * affine;
      powers.box -= (material_.k * (bond.r0 - r) + many_body + damping) * affine;
    }
  }
}

void Ledger::contacts(const Snapshot& s, const Matrix3& gradient, Powers& powers) const {
  const double d = material_.diameter;
  const ContactLaw law{material_.k, material_.gamma, material_.k3, d};
  const std::vector<int> grain_of = packing_.topology(false).grain_of_node();
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(s.position.size()); ++i) {
    for (std::int64_t j = i + 1; j < static_cast<std::int64_t>(s.position.size()); ++j) {
      const Vector3 difference = s.box.minimum_image(s.position[i] - s.position[j]);
      const double r2 = difference.squaredNorm();
      const int g = grain_of[i];
      if (r2 >= d * d) {
        continue;
      }
      const auto n = static_cast<std::int64_t>(packing_.template_of(g).n_nodes());
      if (grain_of[j] == g && bonded_[packing_.grains[g].template_index][(i - first_[g]) * n + j - first_[g]] != 0) {
        continue;
      }
      const double r = std::sqrt(r2);
      const Vector3 e = difference / r;
      const double peculiar = e.dot(s.velocity[i] - s.velocity[j]), affine = e.dot(gradient * difference);
      const double elastic = law.force(r, 0.0);
      const double damping = law.slopes(r, 0.0).by_normal_velocity * peculiar;
      powers.contacts += law.energy(r);
      powers.damping -= damping * peculiar;
      powers.damping_box -= damping * affine;
      powers.box -= (elastic + damping) * affine;
    }
  }
}

Powers Ledger::at(const Snapshot& s, const Matrix3& gradient) const {
  Powers powers;
  for (const Vector3& v : s.velocity) {
    powers.kinetic += 0.5 * material_.node_mass * v.squaredNorm();
  }
  bonds(s, gradient, powers);
  if (!periodic_template_) {
    contacts(s, gradient, powers);
  }
  return powers;
}

} // namespace boba::bench
