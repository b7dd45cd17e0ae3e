// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/packing/sound_packing.h"

#include "bpm/grain/sound_template.h"

#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace boba {

namespace {

/// Shares of the rest length: nearer bonded nodes have no direction that rounding leaves meaning to.
constexpr double least_bond_length = 1e-9;

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

void check_grains(const Packing& packing) {
  for (std::size_t t = 0; t < packing.templates.size(); ++t) {
    if (const auto wrong = unsound_part(*packing.templates[t])) {
      refuse(fmt::format("grain template {}: {}", t, *wrong));
    }
  }
  for (int g = 0; g < packing.n_grains(); ++g) {
    const Grain& grain = packing.grains[g];
    if (grain.template_index < 0 || grain.template_index >= std::ssize(packing.templates)) {
      refuse(fmt::format("grain {} is of template {}; there are {}", grain.molecule, grain.template_index,
                         packing.templates.size()));
    }
    if (!std::isfinite(grain.alpha)) {
      refuse(fmt::format("grain {} has alpha = {}; it must be finite", grain.molecule, grain.alpha));
    }
  }
}

void check_vectors(const Packing& packing, const std::vector<Vector3>& vectors, const char* what, const char* unit) {
  for (std::size_t node = 0; node < vectors.size(); ++node) {
    const Vector3& v = vectors[node];
    if (!is_usable_position(v)) {
      refuse(fmt::format("the {} of node {} is {:g} {:g} {:g} {}; allowed: {:g} to {:g}", what, packing.id[node], v[0],
                         v[1], v[2], unit, -largest_coordinate, largest_coordinate));
    }
  }
}

void check_bonds(const Packing& packing) {
  std::int64_t first = 0;
  for (int g = 0; g < packing.n_grains(); ++g) {
    const GrainTemplate& grain = packing.template_of(g);
    for (const Bond& bond : grain.bonds) {
      Vector3 d = packing.position[first + bond.i] - packing.position[first + bond.j];
      if (grain.period) {
        d = packing.box.minimum_image(d);
      }
      const double least = least_bond_length * bond.r0;
      if (!(d.squaredNorm() >= least * least)) {
        refuse(fmt::format("nodes {} and {} are bonded and lie at the same place, where their bond has no direction; "
                           "move one of them",
                           packing.id[first + bond.i], packing.id[first + bond.j]));
      }
    }
    first += grain.n_nodes();
  }
}

} // namespace

void check_sound(const Packing& packing) {
  check_grains(packing);
  const Box& box = packing.box;
  if (!is_usable_position(box.origin()) || !is_usable_position(box.h().rowwise().sum())) {
    refuse(fmt::format("the cell reaches beyond {:g} d", largest_coordinate));
  }
  if (packing.position.empty()) {
    return;
  }
  const auto n = static_cast<std::size_t>(packing.first_nodes().back());
  if (packing.position.size() != n || packing.id.size() != n ||
      (!packing.velocity.empty() && packing.velocity.size() != n)) {
    refuse(fmt::format("{} positions, {} velocities and {} ids for {} nodes", packing.position.size(),
                       packing.velocity.size(), packing.id.size(), n));
  }
  check_vectors(packing, packing.position, "position", "d");
  check_vectors(packing, packing.velocity, "velocity", "d/tau");
  check_bonds(packing);
}

} // namespace boba
