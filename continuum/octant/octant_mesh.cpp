// SPDX-License-Identifier: GPL-3.0-or-later
#include "continuum/octant/octant_mesh.h"

#include "continuum/sphere/sphere_mesh.h"

#include <algorithm>
#include <cmath>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/manifold_lib.h>

namespace boba::continuum {
namespace {

void name_boundaries(OctantMesh& mesh, const OctantShape& shape) {
  const double small = 1e-8 * shape.radius;
  const bool cylinder = shape.height > 0;
  for (const auto& face : mesh.active_face_iterators()) {
    if (!face->at_boundary()) {
      continue;
    }
    const auto x = face->center();
    const bool side = cylinder && std::abs(x[2] - shape.height / 2) > small;
    face->set_boundary_id(x[0] < small   ? mirror_x
                          : x[1] < small ? mirror_y
                          : x[2] < small ? mirror_z
                          : side         ? octant_lateral
                                         : octant_plate_side);
  }
}

void make_coarse_cylinder(OctantMesh& mesh, const OctantShape& shape) {
  dealii::Triangulation<2> disk;
  dealii::GridGenerator::quarter_hyper_ball(disk, dealii::Point<2>(), shape.radius);
  disk.reset_all_manifolds();
  const auto layers = unsigned(std::max(1., std::round(shape.height / shape.radius)));
  dealii::Triangulation<3> serial;
  dealii::GridGenerator::extrude_triangulation(disk, layers + 1, shape.height / 2, serial);
  mesh.copy_triangulation(serial);
  name_boundaries(mesh, shape);
  for (const auto& face : mesh.active_face_iterators()) {
    if (face->at_boundary() && face->boundary_id() == octant_lateral) {
      face->set_all_manifold_ids(1);
    }
  }
  mesh.set_manifold(1, dealii::CylindricalManifold<3>(2));
}

/// Refines the cells that are larger than wanted; false when there was none.
bool refine_once(OctantMesh& mesh, const OctantShape& shape) {
  bool here = false;
  for (const auto& cell : mesh.active_cell_iterators()) {
    const auto x = cell->center();
    if (cell->is_locally_owned() && cell->diameter() / std::sqrt(3.) > shape.wanted(x[0], x[1], x[2])) {
      cell->set_refine_flag();
      here = true;
    }
  }
  const bool anywhere = dealii::Utilities::MPI::max(int(here), mesh.get_communicator()) > 0;
  mesh.execute_coarsening_and_refinement();
  return anywhere;
}

} // namespace

OctantShape graded_sphere(double radius, double lowest_edge, double highest_edge, double elements_across) {
  SphereMeshSize size;
  size.lowest_edge = lowest_edge;
  size.highest_edge = highest_edge;
  size.elements_across = elements_across;
  size.elements_inside = 0.6 * elements_across;
  size.growth = 0.5;
  OctantShape shape;
  shape.radius = radius;
  shape.wanted = [=](double x, double y, double z) { return wanted_size(std::hypot(x, y), z, 0, radius, size); };
  return shape;
}

void make_octant(OctantMesh& mesh, const OctantShape& shape) {
  if (shape.height > 0) {
    make_coarse_cylinder(mesh, shape);
  } else {
    dealii::GridGenerator::quarter_hyper_ball(mesh, dealii::Point<3>(), shape.radius);
    name_boundaries(mesh, shape);
  }
  mesh.refine_global(shape.refinements);
  while (shape.wanted && refine_once(mesh, shape)) {
  }
}

} // namespace boba::continuum
