// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/cylinder/cylinder_mesh.h"

#include <algorithm>
#include <cmath>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

namespace boba::continuum {
namespace {

/// Steps from 0 to length whose last is about the given one, each longer than its neighbour towards length.
std::vector<double> graded_steps(double length, double last) {
  constexpr double factor = 1.6;
  std::vector<double> steps;
  double sum = 0, step = std::min(last, length);
  while (sum < length * (1 - 1e-12)) {
    steps.push_back(step);
    sum += step;
    step *= factor;
  }
  for (double& scaled : steps) {
    scaled *= length / sum;
  }
  std::reverse(steps.begin(), steps.end());
  return steps;
}

std::shared_ptr<dealii::Triangulation<2>> coarse_rectangle(double radius, double half,
                                                           const std::vector<std::vector<double>>& steps) {
  auto mesh = std::make_shared<dealii::Triangulation<2>>();
  dealii::GridGenerator::subdivided_hyper_rectangle(*mesh, steps, dealii::Point<2>(), dealii::Point<2>(radius, half));
  for (const auto& face : mesh->active_face_iterators()) {
    if (!face->at_boundary()) {
      continue;
    }
    const auto x = face->center();
    face->set_boundary_id(x[0] < 1e-10 * radius         ? axis
                          : x[0] > radius * (1 - 1e-10) ? lateral
                          : x[1] < 1e-10 * half         ? mid_plane
                                                        : plate_side);
  }
  return mesh;
}

} // namespace

MeridianMesh cylinder_mesh(double radius, double height, const CylinderMeshSize& size) {
  const double half = height / 2;
  const double unit = std::min(radius, half);
  auto mesh = coarse_rectangle(radius, half, {graded_steps(radius, unit), graded_steps(half, unit)});
  const dealii::Point<2> corner(radius, half);
  for (bool refined = true; refined;) {
    refined = false;
    for (const auto& cell : mesh->active_cell_iterators()) {
      const double distance = std::max(0., cell->center().distance(corner) - cell->diameter() / 2);
      const double edge = std::min(cell->extent_in_direction(0), cell->extent_in_direction(1));
      const double wanted = std::min(size.corner * unit + size.growth * distance, size.coarsest * unit);
      if (edge > wanted) {
        cell->set_refine_flag();
        refined = true;
      }
    }
    mesh->execute_coarsening_and_refinement();
  }
  return {mesh, 1};
}

MeridianMesh uniform_cylinder_mesh(double radius, double height, unsigned refinements) {
  auto mesh = coarse_rectangle(radius, height / 2, {{radius}, {height / 2}});
  mesh->refine_global(refinements);
  return {mesh, 1};
}

} // namespace boba::continuum
