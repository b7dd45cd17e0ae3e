// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/sphere/sphere_mesh.h"

#include <algorithm>
#include <cmath>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

namespace boba::continuum {
namespace {

/// Degree of the curved boundary: with it the gap of the coarsest surface element is right to 1e-7 R.
constexpr unsigned mapping_degree = 4;

std::shared_ptr<dealii::Triangulation<2>> coarse_disk(double radius) {
  auto mesh = std::make_shared<dealii::Triangulation<2>>();
  dealii::GridGenerator::quarter_hyper_ball(*mesh, dealii::Point<2>(), radius);
  for (const auto& face : mesh->active_face_iterators()) {
    if (!face->at_boundary()) {
      continue;
    }
    const auto center = face->center();
    const bool on_axis = std::abs(center[0]) < 1e-10 * radius;
    const bool on_mid_plane = std::abs(center[1]) < 1e-10 * radius;
    face->set_boundary_id(on_axis ? axis : on_mid_plane ? mid_plane : plate_side);
  }
  return mesh;
}

/// Distance of a cell from the surface point of radius r.
double distance_to_surface(const dealii::Point<2>& x, double half_cell, double radius, double r) {
  return std::max(0., std::hypot(x[0] - r, x[1] - std::sqrt(radius * radius - r * r)) - half_cell);
}

} // namespace

double wanted_size(double r, double z, double half_cell, double radius, const SphereMeshSize& size) {
  const dealii::Point<2> x(r, z);
  const double edge = std::clamp(r, size.lowest_edge, size.highest_edge);
  const double inside = std::min(r, size.lowest_edge);
  const double to_edge = distance_to_surface(x, half_cell, radius, edge);
  const double to_inside = distance_to_surface(x, half_cell, radius, inside);
  return std::min({edge / size.elements_across + size.growth * to_edge,
                   size.lowest_edge / size.elements_inside + size.growth * to_inside, size.coarsest * radius});
}

MeridianMesh sphere_mesh(double radius, const SphereMeshSize& size) {
  auto mesh = coarse_disk(radius);
  for (bool refined = true; refined;) {
    refined = false;
    for (const auto& cell : mesh->active_cell_iterators()) {
      const double edge = cell->diameter() / std::sqrt(2.);
      if (edge > wanted_size(cell->center()[0], cell->center()[1], cell->diameter() / 2, radius, size)) {
        cell->set_refine_flag();
        refined = true;
      }
    }
    mesh->execute_coarsening_and_refinement();
  }
  return {mesh, mapping_degree};
}

MeridianMesh uniform_sphere_mesh(double radius, unsigned refinements) {
  auto mesh = coarse_disk(radius);
  mesh->refine_global(refinements);
  return {mesh, mapping_degree};
}

} // namespace boba::continuum
