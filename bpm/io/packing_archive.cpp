// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/io/packing_archive.h"

#include "bpm/packing/sound_packing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace boba {

namespace {

/// What a file holds is data: fields of the right shape may not fit together all the same.
void require(bool is_so, const char* what) {
  if (!is_so) {
    throw std::invalid_argument(what);
  }
}

bool are_finite(const std::vector<double>& numbers) {
  return std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); });
}

bool are_finite(const std::vector<Vector3>& vectors) {
  return std::ranges::all_of(vectors, [](const Vector3& x) { return x.allFinite(); });
}

void archive_bonds(Archive& archive, GrainTemplate& grain) {
  std::vector<std::int64_t> first, second;
  std::vector<double> r0;
  for (const Bond& bond : grain.bonds) {
    first.push_back(bond.i);
    second.push_back(bond.j);
    r0.push_back(bond.r0);
  }
  archive.field("bond_first_node", first);
  archive.field("bond_second_node", second);
  archive.field("bond_length", r0);
  if (!archive.is_reading()) {
    return;
  }
  require(first.size() == r0.size() && second.size() == r0.size(), "a network has bonds without ends");
  require(are_finite(r0), "a network has bonds whose length is not finite");
  grain.bonds.clear();
  for (std::size_t b = 0; b < r0.size(); ++b) {
    require(first[b] >= 0 && first[b] < second[b] && second[b] < grain.n_nodes() && r0[b] > 0.0,
            "a network has a bond between nodes that are not there");
    grain.bonds.push_back({static_cast<int>(first[b]), static_cast<int>(second[b]), r0[b]});
  }
}

void archive_template(Archive& archive, GrainTemplate& grain) {
  archive.field("position", grain.position);
  archive.field("reference_volume", grain.reference_volume);
  archive.field("period", grain.period);
  bool at_rest = !archive.is_reading() && is_at_rest(grain);
  archive.field("is_at_rest", at_rest);
  if (archive.is_reading()) {
    require(!grain.position.empty() && are_finite(grain.position), "a network has no nodes, or some that are nowhere");
    require(!grain.period || (grain.period->allFinite() && grain.period->minCoeff() > 0.0),
            "a network has a period that is not positive");
  }
  archive_bonds(archive, grain);
  require(!at_rest || is_at_rest(grain), "rest lengths of a network are not those of its undeformed nodes");
}

void archive_templates(Archive& archive, std::vector<std::shared_ptr<const GrainTemplate>>& templates) {
  archive.objects("templates", templates, [](Archive& a, std::shared_ptr<const GrainTemplate>& shared) {
    GrainTemplate grain = shared ? *shared : GrainTemplate();
    archive_template(a, grain);
    shared = a.is_reading() ? std::make_shared<const GrainTemplate>(std::move(grain)) : shared;
  });
}

void archive_cell(Archive& archive, Box& box) {
  Matrix3 h = box.h();
  Vector3 origin = box.origin();
  std::array<bool, 3> periodic = box.periodic();
  archive.field("vectors", h);
  archive.field("origin", origin);
  archive.field("periodic_x", periodic[0]);
  archive.field("periodic_y", periodic[1]);
  archive.field("periodic_z", periodic[2]);
  if (archive.is_reading()) {
    require(h.allFinite() && origin.allFinite() && h.isUpperTriangular(0.0) && h.diagonal().minCoeff() > 0.0,
            "the cell's vectors are not those of a cell");
    box = Box(origin, Vector3::Ones(), Vector3::Zero(), periodic);
    box.set_h(h);
  }
}

/// What breaks the bonds of each grain; fields that are absent where none break.
void archive_breaking(Archive& archive, Packing& packing) {
  std::vector<Grain>& grains = packing.grains;
  std::optional<std::vector<double>> strain, scatter;
  std::optional<std::vector<std::int64_t>> in_tension_only, smooth, seed;
  if (bonds_break(packing)) {
    strain.emplace();
    scatter.emplace();
    in_tension_only.emplace();
    smooth.emplace();
    seed.emplace();
    for (const Grain& grain : grains) {
      strain->push_back(grain.breaking.strain);
      scatter->push_back(grain.breaking.weibull_modulus);
      in_tension_only->push_back(grain.breaking.in_tension_only ? 1 : 0);
      smooth->push_back(grain.breaking.smooth ? 1 : 0);
      seed->push_back(static_cast<std::int64_t>(grain.breaking.seed));
    }
  }
  archive.field("break_strain", strain);
  archive.field("break_scatter", scatter);
  archive.field("break_in_tension_only", in_tension_only);
  archive.field("break_smoothing", smooth);
  archive.field("break_seed", seed);
  if (!archive.is_reading() || !strain) {
    return;
  }
  const std::size_t n = grains.size();
  require(strain->size() == n && scatter && scatter->size() == n && in_tension_only && in_tension_only->size() == n &&
              smooth && smooth->size() == n && seed && seed->size() == n && are_finite(*strain) && are_finite(*scatter),
          "what breaks the bonds does not belong to the grains");
  for (std::size_t g = 0; g < n; ++g) {
    require((*strain)[g] >= 0.0 && (*scatter)[g] >= 0.0, "a grain's bonds break below no strain at all");
    grains[g].breaking = {(*strain)[g], (*in_tension_only)[g] != 0, (*smooth)[g] != 0, (*scatter)[g],
                          static_cast<std::uint64_t>((*seed)[g])};
  }
}

/// When the bonds of each grain yield; fields that are absent where none do.
void archive_yielding(Archive& archive, Packing& packing) {
  std::optional<std::vector<double>> strain, hardening;
  if (bonds_yield(packing)) {
    strain.emplace();
    hardening.emplace();
    for (const Grain& grain : packing.grains) {
      strain->push_back(grain.yielding.strain);
      hardening->push_back(grain.yielding.hardening);
    }
  }
  archive.field("yield_strain", strain);
  archive.field("yield_hardening", hardening);
  if (archive.is_reading() && strain) {
    require(strain->size() == packing.grains.size() && hardening && hardening->size() == strain->size() &&
                are_finite(*strain) && are_finite(*hardening),
            "when the bonds yield does not belong to the grains");
    for (std::size_t g = 0; g < strain->size(); ++g) {
      require((*strain)[g] >= 0.0 && (*hardening)[g] >= 0.0, "a grain's bonds yield below no strain at all");
      packing.grains[g].yielding = {(*strain)[g], (*hardening)[g]};
    }
  }
}

void archive_grains(Archive& archive, Packing& packing) {
  std::vector<std::int64_t> templates, species, molecule;
  std::vector<double> alpha;
  for (const Grain& grain : packing.grains) {
    templates.push_back(grain.template_index);
    species.push_back(grain.species);
    molecule.push_back(grain.molecule);
    alpha.push_back(grain.alpha);
  }
  archive.field("template", templates);
  archive.field("species", species);
  archive.field("molecule", molecule);
  archive.field("alpha", alpha);
  if (!archive.is_reading()) {
    archive_breaking(archive, packing);
    archive_yielding(archive, packing);
    return;
  }
  require(templates.size() == alpha.size() && species.size() == alpha.size() && molecule.size() == alpha.size() &&
              !alpha.empty() && are_finite(alpha),
          "grains without a template or alpha");
  packing.grains.clear();
  for (std::size_t g = 0; g < alpha.size(); ++g) {
    require(templates[g] >= 0 && templates[g] < std::ssize(packing.templates),
            "a grain names a template that is not there");
    packing.grains.push_back({static_cast<int>(templates[g]), static_cast<int>(species[g]), alpha[g], molecule[g]});
  }
  archive_breaking(archive, packing);
  archive_yielding(archive, packing);
}

} // namespace

void archive_packing(Archive& archive, Packing& packing) {
  archive_templates(archive, packing.templates);
  archive.inside("cell", [&] {
    archive_cell(archive, packing.box);
    archive.field("walls_x", packing.walls[0]);
    archive.field("walls_y", packing.walls[1]);
    archive.field("walls_z", packing.walls[2]);
  });
  archive.inside("grains", [&] { archive_grains(archive, packing); });
  archive.field("id", packing.id);
  archive.field("position", packing.position);
  if (archive.is_reading()) {
    const auto n = static_cast<std::size_t>(packing.first_nodes().back());
    require(packing.position.size() == n && packing.id.size() == n && are_finite(packing.position),
            "positions or ids do not belong to the grains");
    packing.velocity.assign(packing.position.size(), Vector3::Zero());
    check_sound(packing);
  }
}

} // namespace boba
