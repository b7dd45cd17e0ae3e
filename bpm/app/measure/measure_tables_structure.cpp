// SPDX-License-Identifier: GPL-3.0-or-later
// The measures of structure and motion; those of order are in measure_tables_order.cpp, those of stress and shape are
// in measure_tables.cpp.
#include "bpm/app/measure/measure_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace boba {

using namespace measure;

void MeasureTables::add_facet_sensitivity(const Frame& frame) {
  for (const auto& [options, grains] : frame.found.sensitivity) {
    const double n = static_cast<double>(grains.size());
    double count = 0.0, share = 0.0;
    for (const FacetSummary& grain : grains) {
      count += grain.n_facets / n;
      share += grain.faceted_share / n;
    }
    std::vector<std::optional<FacetSummary>> undeformed;
    for (const auto& hull : undeformed_hulls_) {
      undeformed.push_back(hull ? std::optional(summary_of(grown_facets(*hull, options))) : std::nullopt);
    }
    write("facet_sensitivity", frame.snapshot,
          {options.min_cosine, options.min_area_share, count, share,
           undeformed_mean(undeformed, [](const FacetSummary& f) { return f.n_facets; }),
           undeformed_mean(undeformed, [](const FacetSummary& f) { return f.faceted_share; })});
  }
}

void MeasureTables::add_scattering(const Frame& frame) {
  for (const ScatteringShell& shell : frame.found.scattering) {
    write("scattering", frame.snapshot,
          {shell.q, static_cast<double>(shell.n_vectors), shell.intensity, shell.form_factor,
           std::isfinite(shell.structure) ? std::optional(shell.structure) : std::nullopt});
  }
}

void MeasureTables::add_contacts(const Frame& frame) {
  const std::vector<GrainContact>& contacts = frame.found.contacts;
  double area = 0.0, force = 0.0;
  for (const GrainContact& c : contacts) {
    Row row = {grain_number(c.grain), grain_number(c.other)};
    for (const double value :
         {static_cast<double>(c.image[0]), static_cast<double>(c.image[1]), static_cast<double>(c.image[2]),
          static_cast<double>(c.n_pairs), c.area, c.largest_overlap}) {
      row.emplace_back(value);
    }
    for (const Vector3& vector : {c.force, c.normal, c.branch, c.point}) {
      row.insert(row.end(), vector.data(), vector.data() + 3);
    }
    write("contacts", frame.snapshot, row);
    area += c.area / static_cast<double>(contacts.size());
    force += c.force.norm() / static_cast<double>(contacts.size());
  }
  const Coordination z = measure::coordination(topology_.n_grains(), contacts);
  const Matrix3 fabric = fabric_tensor(contacts);
  write("coordination", frame.snapshot,
        {z.mean, z.mean_without_rattlers, static_cast<double>(z.n_rattlers), area, force, fabric(0, 0), fabric(1, 1),
         fabric(2, 2), fabric(0, 1), fabric(0, 2), fabric(1, 2), fabric_anisotropy(fabric)});
  note("contacts_per_grain", frame.snapshot, z.mean);
}

void MeasureTables::add_motion(const Frame& frame) {
  const Snapshot& snapshot = frame.snapshot;
  const std::vector<Vector3>& centres = frame.centres;
  if (!past_) {
    past_.emplace(
        Past{snapshot.box, snapshot.strain, centres, frame.neighbours, NonAffineMotion(snapshot.box, centres)});
    return;
  }
  const double strain_step = snapshot.strain - past_->strain;
  past_->motion.add(snapshot.box, centres, strain_step);
  const Matrix3 f = deformation_gradient(past_->box, snapshot.box, strain_step);
  const auto d2min =
      minimal_non_affinity(past_->neighbours, neighbour_displacements(past_->neighbours, past_->centres, centres, f));
  const NeighbourChanges changes = neighbour_changes(past_->neighbours, frame.neighbours);
  const double n = static_cast<double>(centres.size());
  double mean_d2min = 0.0, lost = 0.0, gained = 0.0;
  for (std::size_t g = 0; g < centres.size(); ++g) {
    const Vector3& u = past_->motion.displacements()[g];
    write("grain_motion", snapshot,
          {grain_number(static_cast<int>(g)), u[0], u[1], u[2], d2min[g], static_cast<double>(changes.lost[g]),
           static_cast<double>(changes.gained[g])});
    mean_d2min += d2min[g] / n;
    lost += changes.lost[g] / n;
    gained += changes.gained[g] / n;
  }
  write("motion", snapshot, {past_->motion.mean_square(), mean_d2min, changes.n_grains_changed / n, lost, gained});
  past_->box = snapshot.box;
  past_->strain = snapshot.strain;
  past_->centres = centres;
  past_->neighbours = frame.neighbours;
}

// Layout: box h, origin, periodic, strain | centres | displacements | per grain: number of neighbours, then
// grain, vector, weight of each.
namespace {

/// Lists of neighbours as columns: how many each grain has, then of all neighbours in turn grain, vector and weight.
void archive_neighbours(Archive& archive, NeighbourLists& lists) {
  std::vector<std::int64_t> count, grain;
  std::vector<Vector3> vector;
  std::vector<double> weight;
  for (const auto& list : lists) {
    count.push_back(std::ssize(list));
    for (const Neighbour& neighbour : list) {
      grain.push_back(neighbour.grain);
      vector.push_back(neighbour.vector);
      weight.push_back(neighbour.weight);
    }
  }
  archive.field("count", count);
  archive.field("grain", grain);
  archive.field("vector", vector);
  archive.field("weight", weight);
  if (!archive.is_reading()) {
    return;
  }
  const std::size_t n = grain.size();
  if (count.size() != lists.size() || vector.size() != n || weight.size() != n) {
    archive.fail("count", "does not belong to this packing");
  }
  std::size_t at = 0;
  for (std::size_t g = 0; g < lists.size(); ++g) {
    for (std::int64_t k = 0; k < count[g]; ++k, ++at) {
      if (at >= n || grain[at] < 0 || grain[at] >= std::ssize(lists)) {
        archive.fail("grain", "does not belong to this packing");
      }
      lists[g].push_back({static_cast<int>(grain[at]), vector[at], weight[at]});
    }
  }
}

} // namespace

void MeasureTables::archive_motion(Archive& archive) {
  bool has_past = past_.has_value();
  archive.field("has_past", has_past);
  if (!has_past) {
    return;
  }
  Matrix3 h = past_ ? past_->box.h() : Matrix3();
  Vector3 origin = past_ ? past_->box.origin() : Vector3();
  std::array<bool, 3> periodic = past_ ? past_->box.periodic() : std::array<bool, 3>{};
  double strain = past_ ? past_->strain : 0.0;
  std::vector<Vector3> centres, displacements;
  NeighbourLists neighbours(topology_.n_grains());
  if (past_) {
    centres = past_->centres;
    displacements = past_->motion.displacements();
    neighbours = past_->neighbours;
  }
  archive.field("cell_vectors", h);
  archive.field("cell_origin", origin);
  archive.field("periodic_x", periodic[0]);
  archive.field("periodic_y", periodic[1]);
  archive.field("periodic_z", periodic[2]);
  archive.field("strain", strain);
  archive.field("centres", centres);
  archive.field("displacements", displacements);
  archive.inside("neighbours", [&] { archive_neighbours(archive, neighbours); });
  if (archive.is_reading()) {
    const auto n_grains = static_cast<std::size_t>(topology_.n_grains());
    if (centres.size() != n_grains || displacements.size() != n_grains) {
      archive.fail("centres", "does not belong to this packing");
    }
    Box box(origin, Vector3::Ones(), Vector3::Zero(), periodic);
    box.set_h(h);
    past_.emplace(Past{box, strain, centres, std::move(neighbours), NonAffineMotion(box, centres, displacements)});
  }
}

} // namespace boba
