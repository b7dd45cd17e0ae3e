// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/octant/octant_body.h"

#include "continuum/elasticity/meridian_parts.h"
#include "continuum/octant/octant_system.h"

#include <algorithm>
#include <deal.II/base/timer.h>

namespace boba::continuum {
namespace {

constexpr double solver_tolerance = 1e-9;

/// Vertices in the plane y = 0 on the plate's side of a sphere, or on the free side of a cylinder, of all ranks.
std::vector<FieldPoint> profile_of(const OctantSystem& system) {
  const unsigned boundary = system.shape.height > 0 ? octant_lateral : octant_plate_side;
  const double small = 1e-8 * system.shape.radius;
  std::vector<double> here;
  system.for_each_owned([&](const auto& cell, const auto&) {
    for (const unsigned f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || cell->face(f)->boundary_id() != boundary) {
        continue;
      }
      for (unsigned v = 0; v < 4; ++v) {
        const auto x = cell->face(f)->vertex(v);
        if (x[1] < small) {
          here.insert(here.end(), {x[0], x[2], system.u[cell->face(f)->vertex_dof_index(v, 0)],
                                   system.u[cell->face(f)->vertex_dof_index(v, 2)]});
        }
      }
    }
  });
  std::vector<FieldPoint> points;
  for (const auto& part : dealii::Utilities::MPI::all_gather(system.communicator, here)) {
    for (std::size_t k = 0; k < part.size(); k += 4) {
      points.push_back({part[k], part[k + 1], part[k + 2], part[k + 3]});
    }
  }
  // Two faces share a vertex, and a curved surface is climbed by falling r.
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.z - a.r < b.z - b.r; });
  const auto same = [&](const auto& a, const auto& b) { return std::hypot(a.r - b.r, a.z - b.z) < small; };
  points.erase(std::unique(points.begin(), points.end(), same), points.end());
  return points;
}

} // namespace

OctantBody::OctantBody(const OctantShape& shape, const Discretisation& discretisation, Multigrid multigrid)
    : discretisation_(discretisation), multigrid_(multigrid),
      system_(std::make_unique<OctantSystem>(shape, discretisation.degree)) {}

OctantBody::~OctantBody() = default;

void OctantBody::assemble(const Material& material, OctantSolution& solution) {
  check(material);
  const dealii::Timer timer;
  solution.n_unknowns = long(system_->dofs.n_dofs());
  material_ = material;
  system_->assemble(material, is_projected(discretisation_.formulation, material), multigrid_);
  solution.assemble = {timer.wall_time(), timer.cpu_time()};
}

void OctantBody::finish(OctantSolution& solution) const {
  solution.profile = profile_of(*system_);
}

OctantSolution OctantBody::solve_held(const Material& material, double shortening, bool bonded) {
  OctantSolution solution;
  assemble(material, solution);
  const auto vertical = system_->rows_on(octant_plate_side, 2);
  std::vector<Prescribed> prescribed;
  for (const auto& [row, place] : vertical) {
    prescribed.push_back({row, -shortening / 2});
  }
  for (unsigned component = 0; bonded && component < 2; ++component) {
    for (const auto& [row, place] : system_->rows_on(octant_plate_side, component)) {
      prescribed.push_back({row, 0});
    }
  }
  const OctantEffort effort = system_->solve(prescribed, system_->zero(), solver_tolerance);
  solution.iterations = effort.iterations;
  solution.precondition = effort.precondition;
  solution.solve = effort.solve;
  const auto forces = system_->forces();
  double quarter = 0;
  for (const auto& [row, place] : vertical) {
    quarter -= forces[row];
  }
  solution.force = 4 * dealii::Utilities::MPI::sum(quarter, system_->communicator);
  finish(solution);
  return solution;
}

OctantSolution OctantBody::solve_prescribed(const Material& material, const VectorField& value,
                                            const VectorField& body_force) {
  OctantSolution solution;
  assemble(material, solution);
  std::vector<Prescribed> prescribed;
  for (const auto boundary : {octant_plate_side, octant_lateral}) {
    for (unsigned component = 0; component < 3; ++component) {
      for (const auto& [row, x] : system_->rows_on(boundary, component)) {
        prescribed.push_back({row, value({x[0], x[1], x[2]})[component]});
      }
    }
  }
  const OctantEffort effort = system_->solve(prescribed, system_->body_force(body_force), solver_tolerance);
  solution.iterations = effort.iterations;
  solution.precondition = effort.precondition;
  solution.solve = effort.solve;
  return solution;
}

Eigen::Vector2d OctantBody::error(const VectorField& value, const GradientField& gradient) const {
  return system_->error(value, gradient);
}

} // namespace boba::continuum
