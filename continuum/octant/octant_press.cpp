// SPDX-License-Identifier: GPL-3.0-or-later
// The octant under a rigid plate: a primal-dual active set around the linear solver.
#include "continuum/contact/condensed_contact.h"
#include "continuum/contact/pressure_profile.h"
#include "continuum/octant/octant_body.h"
#include "continuum/octant/octant_system.h"

#include <algorithm>
#include <fmt/format.h>

namespace boba::continuum {
namespace {

using Vector = OctantSystem::Vector;

/// While the set still changes, the displacement need not be right to the last digit.
constexpr double search_tolerance = 1e-5;
constexpr double final_tolerance = 1e-9;

/// A node of the surface, owned by this rank.
struct Node {
  OctantSystem::Index row;
  double r, z, area;
  bool active;
};

std::vector<Node> nodes_of(const OctantSystem& system, double first_radius) {
  const Vector areas = system.plate_areas();
  std::vector<Node> nodes;
  for (const auto& [row, x] : system.rows_on(octant_plate_side, 2)) {
    const double r = std::hypot(x[0], x[1]);
    nodes.push_back({row, r, x[2], areas[row], r < first_radius});
  }
  return nodes;
}

/// Nodes of all ranks whose state contradicted the solution, and by how much at most.
struct Contradictions {
  int nodes;
  /// Pressure that pulls, and overlap of a free node.
  double pull, overlap;
};

/// Flips the nodes whose state contradicts the solution.
Contradictions flip_contradictions(const OctantSystem& system, std::vector<Node>& nodes, const Vector& forces,
                                   double plate) {
  double total = 0;
  for (const Node& node : nodes) {
    total += node.active ? std::abs(forces[node.row]) : 0;
  }
  total = dealii::Utilities::MPI::sum(total, system.communicator);
  Contradictions found{0, 0, 0};
  for (Node& node : nodes) {
    const double pull = forces[node.row], overlap = node.z + system.u[node.row] - plate;
    const bool next = node.active ? pull < 1e-9 * total : overlap > 0;
    if (next != node.active) {
      ++found.nodes;
      found.pull = std::max(found.pull, node.active ? pull / node.area : 0);
      found.overlap = std::max(found.overlap, node.active ? 0 : overlap);
    }
    node.active = next;
  }
  return {dealii::Utilities::MPI::sum(found.nodes, system.communicator),
          dealii::Utilities::MPI::max(found.pull, system.communicator),
          dealii::Utilities::MPI::max(found.overlap, system.communicator)};
}

/// Radius and pressure of the pressed nodes of all ranks, sorted by radius.
std::vector<ProfilePoint> pressures_of(const OctantSystem& system, const std::vector<Node>& nodes,
                                       const Vector& forces) {
  std::vector<double> here;
  for (const Node& node : nodes) {
    if (node.active) {
      here.insert(here.end(), {node.r, -forces[node.row] / node.area, node.area});
    }
  }
  std::vector<ProfilePoint> points;
  for (const auto& part : dealii::Utilities::MPI::all_gather(system.communicator, here)) {
    for (std::size_t k = 0; k < part.size(); k += 3) {
      points.push_back({part[k], part[k + 1], part[k + 2]});
    }
  }
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.r < b.r; });
  return points;
}

} // namespace

OctantSolution OctantBody::press(const Material& material, double plate, double first_radius, int max_active_sets) {
  OctantSolution solution;
  assemble(material, solution);
  const OctantSystem& system = *system_;
  std::vector<Node> nodes = nodes_of(system, first_radius);
  const Vector none = system.zero();
  double tolerance = search_tolerance;
  for (solution.active_set_iterations = 1;; ++solution.active_set_iterations) {
    std::vector<Prescribed> prescribed;
    for (const Node& node : nodes) {
      if (node.active) {
        prescribed.push_back({node.row, plate - node.z});
      }
    }
    const OctantEffort effort = system_->solve(prescribed, none, tolerance);
    solution.iterations = effort.iterations;
    solution.precondition += effort.precondition;
    solution.solve += effort.solve;
    const Vector forces = system.forces();
    const std::vector<Node> solved = nodes;
    const Contradictions left = flip_contradictions(system, nodes, forces, plate);
    if (left.nodes == 0 && tolerance <= final_tolerance) {
      double quarter = 0;
      for (const Node& node : solved) {
        quarter -= node.active ? forces[node.row] : 0;
      }
      solution.force = 4 * dealii::Utilities::MPI::sum(quarter, system.communicator);
      const auto points = pressures_of(system, solved, forces);
      // Few nodes stand across the contact: all of them are taken, and the profile as a whole decides.
      solution.contact_radius = extrapolated_edge(points, 3 * system.finest_spacing(), 0);
      solution.central_pressure = pressure_on_axis(points, solution.contact_radius);
      solution.r.resize(Eigen::Index(points.size()));
      solution.pressure.resize(solution.r.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        solution.r[Eigen::Index(i)] = points[i].r;
        solution.pressure[Eigen::Index(i)] = points[i].pressure;
      }
      finish(solution);
      return solution;
    }
    if (left.nodes > 0 && solution.active_set_iterations >= max_active_sets) {
      throw NotSettled(fmt::format("the active set did not settle in {} iterations: {} nodes contradict it, lowest "
                                   "pressure {:.3e}, largest overlap {:.3e}",
                                   max_active_sets, left.nodes, -left.pull, left.overlap));
    }
    tolerance = left.nodes == 0 ? final_tolerance : tolerance;
  }
}

} // namespace boba::continuum
