// SPDX-License-Identifier: GPL-3.0-or-later
// The measures of order.
#include "bpm/app/measure/measure_tables.h"
#include "bpm/measure/clusters.h"
#include "bpm/measure/long_range_order.h"
#include "bpm/measure/template_matching.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace boba {

using namespace measure;

namespace {

/// What is known of the order of one frame.
struct FrameOrder {
  std::vector<BondOrder> bonds;
  std::vector<TemplateMatch> matches;
  std::vector<Cluster> clusters;
  std::vector<int> cluster_of;        ///< per grain: 1 for the largest cluster, 0 outside of all
  std::vector<double> volumes;        ///< per grain: Voronoi; empty in a cell that is not periodic
  std::optional<BraggPeak> bragg;     ///< likewise
  std::vector<PairShell> pair_shells; ///< likewise
};

FrameOrder order_of(const Box& box, const std::vector<Vector3>& centres, const NeighbourLists& neighbours,
                    const MeasurePlan& plan) {
  FrameOrder order;
  order.bonds = bond_order(neighbours, plan.order);
  order.matches = match_templates(box, centres, plan.templates);
  order.clusters = solid_clusters(box, centres, neighbours, order.bonds, plan.order);
  order.cluster_of.assign(centres.size(), 0);
  for (std::size_t k = 0; k < order.clusters.size(); ++k) {
    for (const int grain : order.clusters[k].grains) {
      order.cluster_of[grain] = static_cast<int>(k) + 1;
    }
  }
  if (box.periodic() == std::array{true, true, true}) {
    order.volumes = voronoi_volumes(box, centres, std::vector<double>(centres.size(), 0.0));
    order.bragg = bragg_peak(box, centres);
    order.pair_shells = pair_distribution(box, centres);
  }
  return order;
}

} // namespace

std::vector<std::string> MeasureTables::order_columns() {
  return {"fcc_share",
          "hcp_share",
          "bcc_share",
          "disordered_share",
          "q4_mean",
          "q6_mean",
          "averaged_q4_mean",
          "averaged_q6_mean",
          "neighbours_mean",
          "unknown_share",
          "template_fcc_share",
          "template_hcp_share",
          "template_bcc_share",
          "template_sc_share",
          "template_icosahedral_share",
          "template_unknown_share",
          "template_rmsd_mean",
          "template_shear_mean",
          "solid_share",
          "clusters",
          "largest_cluster",
          "largest_percolates_x",
          "largest_percolates_y",
          "largest_percolates_z",
          "largest_finite_cluster",
          "bragg_peak",
          "voronoi_volume_mean_d3",
          "voronoi_volume_deviation_d3",
          "rest_tau"};
}

std::vector<std::string> MeasureTables::grain_order_columns() {
  return {"grain",          "q4",          "q6",
          "averaged_q4",    "averaged_q6", "averaged_w4",
          "averaged_w6",    "neighbours",  "solid_bonds",
          "class",          "template",    "template_rmsd",
          "template_shear", "cluster",     "voronoi_volume_d3"};
}

namespace {

/// Means over the grains of a frame, as they stand in the columns of `order`.
class OrderRow {
public:
  explicit OrderRow(const FrameOrder& order) : order_(order), n_(static_cast<double>(order.bonds.size())) {}

  /// \param rest how long copies of the frames rested, tau
  std::vector<std::optional<double>> row(double rest) {
    add_bond_order();
    add_templates();
    add_clusters();
    add_long_range_order();
    row_.emplace_back(rest);
    return std::move(row_);
  }
  /// Share of grains that are fcc, hcp or bcc by the signs of w4 and w6.
  double ordered_share() const { return share(classes_, CrystalClass::fcc, CrystalClass::hcp, CrystalClass::bcc); }
  /// The same by template matching.
  double template_ordered_share() const { return share(lattices_, Lattice::fcc, Lattice::hcp, Lattice::bcc); }

private:
  template <class Counts, class... Kind> double share(const Counts& counts, Kind... kind) const {
    return (counts[static_cast<std::size_t>(kind)] + ...) / n_;
  }
  template <class Value> double mean(const Value& value) const {
    double sum = 0.0;
    for (std::size_t g = 0; g < order_.bonds.size(); ++g) {
      sum += static_cast<double>(value(g));
    }
    return sum / n_;
  }
  void add_bond_order() {
    for (const CrystalClass crystal :
         {CrystalClass::fcc, CrystalClass::hcp, CrystalClass::bcc, CrystalClass::disordered}) {
      row_.emplace_back(share(classes_, crystal));
    }
    row_.emplace_back(mean([&](std::size_t g) { return order_.bonds[g].q4; }));
    row_.emplace_back(mean([&](std::size_t g) { return order_.bonds[g].q6; }));
    row_.emplace_back(mean([&](std::size_t g) { return order_.bonds[g].averaged_q4; }));
    row_.emplace_back(mean([&](std::size_t g) { return order_.bonds[g].averaged_q6; }));
    row_.emplace_back(mean([&](std::size_t g) { return order_.bonds[g].n_neighbours; }));
    row_.emplace_back(share(classes_, CrystalClass::unknown));
  }
  void add_templates() {
    for (const Lattice lattice :
         {Lattice::fcc, Lattice::hcp, Lattice::bcc, Lattice::sc, Lattice::icosahedral, Lattice::unknown}) {
      row_.emplace_back(share(lattices_, lattice));
    }
    row_.emplace_back(mean([&](std::size_t g) { return order_.matches[g].rmsd; }));
    row_.emplace_back(mean([&](std::size_t g) { return order_.matches[g].shear; }));
  }
  void add_clusters() {
    row_.emplace_back(mean([&](std::size_t g) { return order_.cluster_of[g] > 0; }));
    const Cluster largest = order_.clusters.empty() ? Cluster{} : order_.clusters.front();
    row_.emplace_back(static_cast<double>(order_.clusters.size()));
    row_.emplace_back(static_cast<double>(largest.grains.size()));
    for (const bool percolates : largest.percolates) {
      row_.emplace_back(percolates ? 1.0 : 0.0);
    }
    row_.emplace_back(static_cast<double>(largest_finite(order_.clusters)));
  }
  void add_long_range_order() {
    if (order_.volumes.empty()) {
      row_.resize(row_.size() + 3);
      return;
    }
    const double volume = mean([&](std::size_t g) { return order_.volumes[g]; });
    row_.emplace_back(order_.bragg->height);
    row_.emplace_back(volume);
    row_.emplace_back(std::sqrt(mean([&](std::size_t g) { return std::pow(order_.volumes[g] - volume, 2); })));
  }

  const FrameOrder& order_;
  double n_;
  std::array<int, n_crystal_classes> classes_ = count_classes(order_.bonds);
  std::array<int, n_lattices> lattices_ = count_lattices(order_.matches);
  std::vector<std::optional<double>> row_;
};

} // namespace

void MeasureTables::add_order(const Frame& frame) {
  const std::vector<Vector3> rested =
      frame_rest_ ? frame_rest_->rested_centres(frame.snapshot) : std::vector<Vector3>();
  const FrameOrder order = frame_rest_ ? order_of(frame.snapshot.box, rested, neighbours_of(frame, rested), plan_)
                                       : order_of(frame.snapshot.box, frame.centres, frame.neighbours, plan_);
  for (std::size_t g = 0; g < order.bonds.size(); ++g) {
    const BondOrder& o = order.bonds[g];
    const TemplateMatch& match = order.matches[g];
    write("grain_order", frame.snapshot,
          {grain_number(static_cast<int>(g)), o.q4, o.q6, o.averaged_q4, o.averaged_q6, o.averaged_w4, o.averaged_w6,
           static_cast<double>(o.n_neighbours), static_cast<double>(o.n_solid_bonds), static_cast<double>(o.crystal),
           static_cast<double>(match.lattice), match.rmsd, match.shear, static_cast<double>(order.cluster_of[g]),
           order.volumes.empty() ? std::nullopt : std::optional(order.volumes[g])});
  }
  for (const PairShell& shell : order.pair_shells) {
    write("pair_distribution", frame.snapshot, {shell.r, static_cast<double>(shell.n_pairs), shell.g});
  }
  OrderRow means(order);
  write("order", frame.snapshot, means.row(frame_rest_ ? plan_.rest.value_or(0.0) : 0.0));
  note("ordered_share", frame.snapshot, means.ordered_share());
  note("template_ordered_share", frame.snapshot, means.template_ordered_share());
}

} // namespace boba
