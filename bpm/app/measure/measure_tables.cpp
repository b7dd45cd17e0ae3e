// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/app/measure/measure_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

namespace boba {

using namespace measure;

namespace {

struct Spread {
  double mean = 0.0, deviation = 0.0;
};

Spread spread(const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  Spread result;
  result.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  for (const double value : values) {
    result.deviation += (value - result.mean) * (value - result.mean) / n;
  }
  result.deviation = std::sqrt(result.deviation);
  return result;
}

template <class Value> double mean_of(std::size_t n, const Value& value) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    sum += value(i);
  }
  return n > 0 ? sum / static_cast<double>(n) : 0.0;
}

const std::vector<std::string> frame_columns = {"step", "time_tau", "strain"};

Tensor6 total_stress(const std::vector<Tensor6>& grains, const Box& box) {
  Tensor6 total{};
  for (const Tensor6& grain : grains) {
    for (std::size_t c = 0; c < total.size(); ++c) {
      total[c] += grain[c] / box.volume();
    }
  }
  return total;
}

/// Those of the program's own measures. \throws std::invalid_argument when two measures write a table of one name.
void add_outside_tables(const MeasurePlan& plan, std::vector<MeasureTable>& tables) {
  for (const auto& measure : make_outside_measures(plan.outside)) {
    for (const MeasureTable& outside : measure->tables()) {
      tables.push_back({outside.name, frame_columns});
      tables.back().columns.insert(tables.back().columns.end(), outside.columns.begin(), outside.columns.end());
    }
  }
  std::set<std::string> names;
  for (const MeasureTable& written : tables) {
    if (!names.insert(written.name).second) {
      throw std::invalid_argument(fmt::format("measure: two measures write a table '{}'", written.name));
    }
  }
}

} // namespace

MeasureTables::MeasureTables(std::filesystem::path folder, const Topology& topology, MeasurePlan plan,
                             const UndeformedGrains& undeformed, FileMode mode, std::int64_t last_step,
                             const Ranks& ranks, Opening opening)
    : folder_(std::move(folder)), topology_(topology), plan_(std::move(plan)), ranks_(ranks), mode_(mode) {
  if (!ranks_.is_root()) {
    return;
  }
  if (plan_.has(MeasureKind::shape) || plan_.has(MeasureKind::packing_fraction)) {
    for (const std::vector<Vector3>& nodes : undeformed.nodes) {
      undeformed_hulls_.push_back(nodes.empty() ? std::nullopt : std::optional(convex_hull(nodes)));
    }
  }
  undeformed_hulls_.resize(1 + *std::max_element(topology_.template_index.begin(), topology_.template_index.end()));
  for (const auto& hull : undeformed_hulls_) {
    undeformed_.push_back(hull ? std::optional(grain_shape(*hull, plan_.facets)) : std::nullopt);
  }
  for (int g = 0; g < topology_.n_grains(); ++g) {
    nominal_volume_ += nominal_volume(static_cast<int>(topology_.first_node[g + 1] - topology_.first_node[g]));
  }
  outside_ = make_outside_measures(plan_.outside);
  if (opening == Opening::now) {
    open(last_step);
  }
}

void MeasureTables::open(std::int64_t last_step) {
  std::filesystem::create_directories(folder_);
  for (const MeasureTable& table : tables_of(plan_)) {
    const std::filesystem::path path = folder_ / (table.name + ".csv");
    tables_.emplace(table.name, mode_ == FileMode::append ? TableWriter::go_on(path, table.columns, last_step)
                                                          : TableWriter(path, table.columns, mode_));
  }
  is_open_ = true;
}

std::vector<MeasureTable> MeasureTables::tables_of(const MeasurePlan& plan) {
  std::vector<MeasureTable> tables;
  const auto table = [&](MeasureKind kind, const std::string& name, const std::vector<std::string>& columns) {
    if (plan.has(kind)) {
      tables.push_back({name, frame_columns});
      tables.back().columns.insert(tables.back().columns.end(), columns.begin(), columns.end());
    }
  };
  using enum MeasureKind;
  table(stress, "stress",
        {"xx_k/d", "yy_k/d", "zz_k/d", "xy_k/d", "xz_k/d", "yz_k/d", "P_k/d", "mu", "N1_k/d", "N2_k/d",
         "kinetic_xx_k/d", "kinetic_yy_k/d", "kinetic_zz_k/d", "kinetic_xy_k/d", "kinetic_xz_k/d", "kinetic_yz_k/d",
         "with_damping", "P_run_k/d", "mu_run"});
  table(stress, "grain_stress", {"grain", "xx_kd2", "yy_kd2", "zz_kd2", "xy_kd2", "xz_kd2", "yz_kd2"});
  table(packing_fraction, "packing_fraction",
        {"phi", "phi_error", "phi_nodes", "phi_nodes_error", "phi_hulls", "phi_hulls_error", "points", "phi_reference",
         "phi_undeformed_hulls"});
  table(shape, "grains",
        {"grain", "species", "volume_d3", "area_d2", "asphericity", "moment_1_d2", "moment_2_d2", "moment_3_d2",
         "facets", "faceted_share", "facets_transitive", "faceted_share_transitive"});
  table(shape, "facets", {"grain", "facet", "area_d2", "normal_x", "normal_y", "normal_z"});
  std::vector<std::string> summary = {
      "volume_mean_d3",      "volume_deviation_d3", "asphericity_mean",       "asphericity_deviation",   "facets_mean",
      "twelve_facets_share", "faceted_share",       "facets_transitive_mean", "faceted_share_transitive"};
  for (const char* name :
       {"volume_d3", "asphericity", "facets", "faceted_share", "facets_transitive", "faceted_share_transitive"}) {
    summary.push_back(std::string("undeformed_") + name);
  }
  table(shape, "shape", summary);
  if (plan.facet_sensitivity) {
    table(shape, "facet_sensitivity",
          {"min_cosine", "min_area_share", "facets_mean", "faceted_share", "undeformed_facets",
           "undeformed_faceted_share"});
  }
  table(scattering, "scattering", {"q_1/d", "vectors", "intensity", "form_factor", "structure"});
  table(order, "order", order_columns());
  table(order, "grain_order", grain_order_columns());
  table(order, "pair_distribution", {"r_d", "pairs", "g"});
  table(contacts, "contacts",
        {"grain",      "other",      "image_a",    "image_b",    "image_c",   "pairs",    "area_d2",
         "overlap_d",  "force_x_kd", "force_y_kd", "force_z_kd", "normal_x",  "normal_y", "normal_z",
         "branch_x_d", "branch_y_d", "branch_z_d", "point_x_d",  "point_y_d", "point_z_d"});
  table(contacts, "coordination",
        {"contacts_per_grain", "contacts_without_rattlers", "rattlers", "area_mean_d2", "force_mean_kd", "fabric_xx",
         "fabric_yy", "fabric_zz", "fabric_xy", "fabric_xz", "fabric_yz", "fabric_anisotropy"});
  table(motion, "motion",
        {"non_affine_square_d2", "d2min_mean_d2", "changed_share", "lost_per_grain", "gained_per_grain"});
  table(motion, "grain_motion",
        {"grain", "displacement_x_d", "displacement_y_d", "displacement_z_d", "d2min_d2", "lost", "gained"});
  add_outside_tables(plan, tables);
  return tables;
}

void MeasureTables::write(const std::string& table, const Snapshot& snapshot, const Row& values) {
  Row row = {snapshot.time, snapshot.strain};
  row.insert(row.end(), values.begin(), values.end());
  if (is_open_) {
    tables_.at(table).write(snapshot.step, row);
  } else {
    waiting_.push_back({table, snapshot.step, std::move(row)});
  }
}

void MeasureTables::note(const std::string& quantity, const Snapshot& snapshot, double value) {
  series_[quantity].strain.push_back(snapshot.strain);
  series_[quantity].value.push_back(value);
}

double MeasureTables::grain_number(int grain) const {
  return static_cast<double>(topology_.molecule[grain]);
}

void MeasureTables::add(const Snapshot& snapshot) {
  Frame frame{
      snapshot, measure_together(snapshot.box, snapshot.position, topology_.first_node, plan_, ranks_), {}, {}, {}};
  if (plan_.has(MeasureKind::stress)) {
    frame.grain_stress = frame_stress_ ? frame_stress_->evaluate(snapshot) : snapshot.grain_stress;
  }
  ranks_.on_root([&] { write_frame(frame); });
}

void MeasureTables::write_frame(Frame& frame) {
  using enum MeasureKind;
  if (plan_.has(order) || plan_.has(motion)) {
    find_neighbours(frame);
  }
  if (plan_.has(stress)) {
    add_stress(frame);
  }
  if (plan_.has(packing_fraction)) {
    add_packing_fraction(frame);
  }
  if (plan_.has(shape)) {
    add_shape(frame);
  }
  if (plan_.has(shape) && plan_.facet_sensitivity) {
    add_facet_sensitivity(frame);
  }
  if (plan_.has(scattering)) {
    add_scattering(frame);
  }
  if (plan_.has(order)) {
    add_order(frame);
  }
  if (plan_.has(contacts)) {
    add_contacts(frame);
  }
  if (plan_.has(motion)) {
    add_motion(frame);
  }
  add_outside(frame);
  if (!is_open_) {
    open(-1);
    for (const auto& [table, step, values] : std::exchange(waiting_, {})) {
      tables_.at(table).write(step, values);
    }
  }
}

NeighbourLists MeasureTables::neighbours_of(const Frame& frame, const std::vector<Vector3>& centres) const {
  return plan_.neighbours == NeighbourRule::voronoi
             ? voronoi_neighbours(frame.snapshot.box, centres, frame.found.hull_radii)
             : solid_angle_neighbours(frame.snapshot.box, centres);
}

void MeasureTables::find_neighbours(Frame& frame) const {
  frame.centres = grain_centres(GrainNodes(frame.snapshot.position, topology_.first_node));
  frame.neighbours = neighbours_of(frame, frame.centres);
}

void MeasureTables::add_stress(const Frame& frame) {
  const Snapshot& snapshot = frame.snapshot;
  const std::vector<Tensor6>& grains = frame.grain_stress;
  for (std::size_t grain = 0; grain < grains.size(); ++grain) {
    Row row = {grain_number(static_cast<int>(grain))};
    row.insert(row.end(), grains[grain].begin(), grains[grain].end());
    write("grain_stress", snapshot, row);
  }
  const Tensor6 total = total_stress(grains, snapshot.box);
  const StressSummary summary = summarise_stress(total);
  Row row(total.begin(), total.end());
  const auto known = [](double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; };
  for (const double value : {summary.pressure, summary.mu, summary.normal_difference_1, summary.normal_difference_2}) {
    row.push_back(known(value));
  }
  if (snapshot.velocity.empty()) {
    row.resize(row.size() + 6); // without velocities the kinetic part cannot be told apart: empty fields
  } else {
    Matrix3 gradient = Matrix3::Zero();
    gradient(0, 1) = snapshot.streaming_rate;
    const Tensor6 kinetic =
        kinetic_stress(snapshot.box, snapshot.position, snapshot.velocity, plan_.material.node_mass, gradient);
    row.insert(row.end(), kinetic.begin(), kinetic.end());
  }
  const bool with_damping = !frame_stress_ || !snapshot.velocity.empty();
  const StressSummary of_run = summarise_stress(total_stress(snapshot.grain_stress, snapshot.box));
  for (const double value : {with_damping ? 1.0 : 0.0, of_run.pressure, of_run.mu}) {
    row.push_back(known(value));
  }
  write("stress", snapshot, row);
  if (std::isfinite(summary.mu)) {
    note("mu", snapshot, summary.mu);
  }
  note("P_k/d", snapshot, summary.pressure);
}

void MeasureTables::add_packing_fraction(const Frame& frame) {
  const PackingFraction& phi = *frame.found.packing_fraction;
  const auto volume = undeformed_mean(undeformed_, [](const GrainShape& s) { return s.shape.volume; });
  write("packing_fraction", frame.snapshot,
        {phi.both.value, phi.both.standard_error, phi.nodes.value, phi.nodes.standard_error, phi.hulls.value,
         phi.hulls.standard_error, static_cast<double>(phi.n_points), nominal_volume_ / frame.snapshot.box.volume(),
         volume ? std::optional(*volume * topology_.n_grains() / frame.snapshot.box.volume()) : std::nullopt});
  note("phi", frame.snapshot, phi.both.value);
}

void MeasureTables::add_shape(const Frame& frame) {
  const std::vector<GrainShape>& shapes = frame.found.shapes;
  std::vector<double> volumes, asphericities;
  for (std::size_t g = 0; g < shapes.size(); ++g) {
    const auto& [shape, grown, transitive] = shapes[g];
    volumes.push_back(shape.volume);
    asphericities.push_back(shape.asphericity);
    const double number = grain_number(static_cast<int>(g));
    write("grains", frame.snapshot,
          {number, static_cast<double>(topology_.species[g]), shape.volume, shape.area, shape.asphericity,
           shape.moments[0], shape.moments[1], shape.moments[2], static_cast<double>(grown.n_facets),
           grown.faceted_share, static_cast<double>(transitive.n_facets), transitive.faceted_share});
    double f = 0.0;
    for (const auto& [area, n] : frame.found.facets[g]) {
      write("facets", frame.snapshot, {number, f++, area, n[0], n[1], n[2]});
    }
  }
  const auto mean = [&](const auto& value) {
    return mean_of(shapes.size(), [&](std::size_t g) { return static_cast<double>(value(shapes[g])); });
  };
  const Spread volume = spread(volumes), asphericity = spread(asphericities);
  Row row = {volume.mean,
             volume.deviation,
             asphericity.mean,
             asphericity.deviation,
             mean([](const GrainShape& s) { return s.grown.n_facets; }),
             mean([](const GrainShape& s) { return s.grown.n_facets == 12; }),
             mean([](const GrainShape& s) { return s.grown.faceted_share; }),
             mean([](const GrainShape& s) { return s.transitive.n_facets; }),
             mean([](const GrainShape& s) { return s.transitive.faceted_share; })};
  const auto undeformed = [&](const auto& value) { row.push_back(undeformed_mean(undeformed_, value)); };
  undeformed([](const GrainShape& s) { return s.shape.volume; });
  undeformed([](const GrainShape& s) { return s.shape.asphericity; });
  undeformed([](const GrainShape& s) { return s.grown.n_facets; });
  undeformed([](const GrainShape& s) { return s.grown.faceted_share; });
  undeformed([](const GrainShape& s) { return s.transitive.n_facets; });
  undeformed([](const GrainShape& s) { return s.transitive.faceted_share; });
  write("shape", frame.snapshot, row);
  note("volume_mean_d3", frame.snapshot, volume.mean);
  note("asphericity_mean", frame.snapshot, asphericity.mean);
  note("facets_mean", frame.snapshot, *row[4]);
}

void MeasureTables::add_outside(const Frame& frame) {
  for (const auto& measure : outside_) {
    const std::vector<MeasureTable> tables = measure->tables();
    measure->add(frame.snapshot, topology_, [&](const std::string& name, const Row& values) {
      const auto table = std::ranges::find(tables, name, &MeasureTable::name);
      if (table == tables.end() || table->columns.size() != values.size()) {
        throw std::invalid_argument(fmt::format("measure: a row of {} values for table '{}' fits none of the measure's "
                                                "own tables",
                                                values.size(), name));
      }
      write(name, frame.snapshot, values);
      for (std::size_t c = 0; table->is_averaged && c < values.size(); ++c) {
        if (values[c]) {
          note(table->columns[c], frame.snapshot, *values[c]);
        }
      }
    });
  }
}

} // namespace boba
